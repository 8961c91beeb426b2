
int @name@_derivative(@name@_state *s, const double qd[], const double qdd[], const @name@_direction *along,
                      @name@_output *o, @name@_output *d)
{
    @name@_position p = s->position;
    double dx[@outputs@];
    const int result = @name@_results(&p, @state_geometry@qd, qdd, s->work, o);

    if (result != @NAME@_OK)
        return result;
    /* Where the constraints hold, the correction changes with a driver or the design as the coordinates must. */
    @name@_correct_tangent(p.x, p.q, @nominal@along, s->work, dx);
@follows@    @name@_motion_tangent(p.x, p.q, qd, qdd, dx, @nominal@along, s->work, d);
@derived_measures@    d->residual = d->pivot_ratio = 0.0;
    d->moves = d->corrections = 0;
    return @NAME@_OK;
}
