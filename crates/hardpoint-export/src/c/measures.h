
/* Measures and components of points: indices of `measure`. */
enum {
@measure_constants@
};

/* A measure; NaN where it is undefined. */
typedef struct @name@_measure_value {
    double value;
    double rate;         /* per s */
    double acceleration; /* per s^2 */
} @name@_measure_value;
