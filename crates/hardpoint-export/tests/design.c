/* Reads a design, then positions, velocities and accelerations of the drivers, step by step. Prints the result of the
 * change, and of every step the measures and their derivatives by the design. */
#include "@name@.h"

#include <stdio.h>

int main(void)
{
    static @name@_measure_value gradient[@NAME@_MEASURES][@NAME@_DESIGN];
    @name@_state state;
    @name@_output o, d;
    double design[@NAME@_DESIGN], q[@NAME@_DRIVERS], qd[@NAME@_DRIVERS], qdd[@NAME@_DRIVERS];
    int k, b;

    for (k = 0; k < @NAME@_DESIGN; ++k)
        if (scanf("%lf", &design[k]) != 1)
            return 1;
    @name@_init(&state);
    printf("%d\n", @name@_set_design(&state, design, &o));
    for (;;) {
        int result;
        for (k = 0; k < @NAME@_DRIVERS; ++k)
            if (scanf("%lf %lf %lf", &q[k], &qd[k], &qdd[k]) != 3)
                return 0;
        result = @name@_step(&state, q, qd, qdd, &o);
        printf("%d", result);
        if (result == @NAME@_OK) {
            for (k = 0; k < @NAME@_MEASURES; ++k)
                printf(" %.17g %.17g %.17g", o.measure[k].value, o.measure[k].rate, o.measure[k].acceleration);
            result = @name@_gradient(&state, qd, qdd, gradient, &o, &d);
            if (result != @NAME@_OK)
                return result;
            for (k = 0; k < @NAME@_MEASURES; ++k)
                for (b = 0; b < @NAME@_DESIGN; ++b)
                    printf(" %.17g %.17g %.17g", gradient[k][b].value, gradient[k][b].rate,
                           gradient[k][b].acceleration);
        }
        printf("\n");
    }
}
