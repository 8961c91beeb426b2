
int @name@_set_design(@name@_state *s, const double design[], @name@_output *o)
{
    const @name@_position at = s->position;
    const double rest[@NAME@_DRIVERS] = {0.0};
    int k;

    for (k = 0; k < @NAME@_DESIGN; ++k) {
        if (!(fabs(design[k]) <= DBL_MAX))
            return @NAME@_NOT_FINITE;
    }
    return @name@_travel(s, at.q, rest, rest, design, o);
}
