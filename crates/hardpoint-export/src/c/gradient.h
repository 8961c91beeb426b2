
/* Derivatives of all measures by all design variables, at the position of the state with these velocities and
 * accelerations of the drivers; NaN by a variable that the mechanism cannot follow here. The outputs are used as
 * working memory. */
int @name@_gradient(@name@_state *state, const double qd[], const double qdd[],
                    @name@_measure_value gradient[@NAME@_MEASURES][@NAME@_DESIGN], @name@_output *output,
                    @name@_output *derivative);
