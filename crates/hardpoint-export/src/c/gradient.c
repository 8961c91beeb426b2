
int @name@_gradient(@name@_state *s, const double qd[], const double qdd[],
                    @name@_measure_value gradient[@NAME@_MEASURES][@NAME@_DESIGN], @name@_output *o, @name@_output *d)
{
    static const @name@_direction none;
    @name@_direction along = none;
    int k, m;

    for (k = 0; k < @NAME@_DESIGN; ++k) {
        int result;
        along.design[k] = 1.0;
        result = @name@_derivative(s, qd, qdd, &along, o, d);
        along.design[k] = 0.0;
        if (result != @NAME@_OK && result != @NAME@_LOCKED)
            return result;
        for (m = 0; m < @NAME@_MEASURES; ++m) {
            gradient[m][k] = d->measure[m];
            if (result == @NAME@_LOCKED)
                gradient[m][k].value = gradient[m][k].rate = gradient[m][k].acceleration = NAN;
        }
    }
    return @NAME@_OK;
}
