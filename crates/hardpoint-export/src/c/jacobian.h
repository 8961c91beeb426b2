
/* Derivatives of the measures by the drivers at the position of the state: rates for unit velocities. The output is
 * used as working memory. */
int @name@_jacobian(@name@_state *state, double jacobian[@NAME@_MEASURES][@NAME@_DRIVERS], @name@_output *output);
