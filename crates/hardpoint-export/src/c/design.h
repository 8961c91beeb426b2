
/* Changes the design: changes of the design variables from the values of the model file, in the units above.
 *
 * The position follows at constant drivers, and the output is that of a mechanism at rest. A failure leaves the state
 * as it was, and the output undefined. */
int @name@_set_design(@name@_state *state, const double design[], @name@_output *output);
