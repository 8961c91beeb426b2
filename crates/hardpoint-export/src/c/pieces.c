/* Copies the piece of a curve at u: where it begins, then the coefficients of x, and of y, by powers of the parameter
 * from there. It is NaN beyond the ends of an open curve; a closed one goes on. */
static void @name@_piece(const double (*pieces)[@piece@], int count, double length, int closed, double u, double *to)
{
    const double turns = closed ? length * floor(u / length) : 0.0, within = u - turns, slack = 1e-12 * length;
    /* NaN is beyond the ends, too. */
    const int is_on_curve = within >= -slack && within <= length + slack;
    int k, low = 0, high = count - 1;

    while (is_on_curve && low < high) {
        const int middle = (low + high + 1) / 2;
        if (pieces[middle][0] <= within)
            low = middle;
        else
            high = middle - 1;
    }
    for (k = 0; k < @piece@; ++k)
        to[k] = is_on_curve ? pieces[low][k] : NAN;
    to[0] += turns;
}

/* Copies the pieces of all curves at their contacts behind the coordinates. */
static void @name@_place_pieces(double *x)
{
@calls@}

