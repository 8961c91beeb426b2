/* Reads positions, velocities and accelerations of the drivers, step by step, and prints the results. */
#include "@name@.h"

#include <stdio.h>

int main(void)
{
    @name@_state state;
    @name@_output o;
    double q[@NAME@_DRIVERS], qd[@NAME@_DRIVERS], qdd[@NAME@_DRIVERS];
    int k;

    @name@_init(&state);
    for (;;) {
        int result;
        for (k = 0; k < @NAME@_DRIVERS; ++k)
            if (scanf("%lf %lf %lf", &q[k], &qd[k], &qdd[k]) != 3)
                return 0;
        result = @name@_step(&state, q, qd, qdd, &o);
        printf("%d %d", result, o.moves);
        for (k = 0; result == @NAME@_OK && k < @NAME@_BODIES; ++k) {
            const @name@_body *b = &o.body[k];
            int i;
            for (i = 0; i < 3; ++i)
                printf(" %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g", b->r[i], b->axis[0][i], b->axis[1][i],
                       b->axis[2][i], b->v[i], b->omega[i], b->a[i], b->alpha[i]);
        }
#if @NAME@_MEASURES > 0
        if (result == @NAME@_OK) {
            static double jacobian[@NAME@_MEASURES][@NAME@_DRIVERS];
            for (k = 0; k < @NAME@_MEASURES; ++k)
                printf(" %.17g %.17g %.17g", o.measure[k].value, o.measure[k].rate, o.measure[k].acceleration);
            @name@_jacobian(&state, jacobian, &o);
            for (k = 0; k < @NAME@_MEASURES; ++k) {
                int d;
                for (d = 0; d < @NAME@_DRIVERS; ++d)
                    printf(" %.17g", jacobian[k][d]);
            }
        }
#endif
        printf("\n");
    }
}
