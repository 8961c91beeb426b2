/* The larger of two numbers; NaN if either is NaN. */
static double @name@_larger(double a, double b)
{
    return b <= a || a != a ? a : b;
}

