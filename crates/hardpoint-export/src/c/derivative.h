
/* Direction in the space of the arguments of a step@and_of_design@. */
typedef struct @name@_direction {
    double q[@NAME@_DRIVERS];
    double qd[@NAME@_DRIVERS];
    double qdd[@NAME@_DRIVERS];
@direction_field@} @name@_direction;

/* Derivatives of all results in a direction, at the position of the state with these velocities and accelerations. The
 * results go to `output`, their exact derivatives to `derivative`.@locked@ */
int @name@_derivative(@name@_state *state, const double qd[], const double qdd[], const @name@_direction *along,
                      @name@_output *output, @name@_output *derivative);
