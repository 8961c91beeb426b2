
int @name@_jacobian(@name@_state *s, double jacobian[@NAME@_MEASURES][@NAME@_DRIVERS], @name@_output *o)
{
    double qd[@NAME@_DRIVERS] = {0.0};
    const double rest[@NAME@_DRIVERS] = {0.0};
    int d, m;

    for (d = 0; d < @NAME@_DRIVERS; ++d) {
        @name@_position position = s->position;
        int result;
        qd[d] = 1.0;
        result = @name@_results(&position, @state_geometry@qd, rest, s->work, o);
        qd[d] = 0.0;
        if (result != @NAME@_OK)
            return result;
        for (m = 0; m < @NAME@_MEASURES; ++m)
            jacobian[m][d] = o->measure[m].rate;
    }
    return @NAME@_OK;
}
