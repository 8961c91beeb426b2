
/* Change, in units of the coordinates or of the design, by which redundant constraints are probed. */
#define @NAME@_NEARBY 1e-8
/* Most that a redundant constraint may open per change; one that stays closed opens by the square of the change. */
#define @NAME@_MOST_DEFECT 1e-5

/* Most that redundant constraints may be open where the design changes: ten times as in the motion of the nominal design,
 * or round-off. */
#define @NAME@_MOST_MISFIT @misfit@

/* True if redundant constraints stay closed, to first order, in a direction that changes the design. */
static int @name@_follows(@name@_state *s, const @name@_position *p, const @name@_direction *along, const double *dx,
                          double residual, @name@_output *scratch)
{
    const double rest[@NAME@_DRIVERS] = {0.0};
    @name@_position near = *p;
    double check[@checks@], size = 0.0, step;
    int k;

    for (k = 0; k < @NAME@_DESIGN; ++k)
        size = @name@_greater(size, fabs(along->design[k]));
    if (!(size > 0.0))
        return 1;
    if (!(residual <= @NAME@_MOST_MISFIT))
        return 0;
    for (k = 0; k < @NAME@_COORDINATES; ++k)
        size = @name@_greater(size, fabs(dx[k]) / @name@_coordinate_unit[k]);
    step = @NAME@_NEARBY / size;
    for (k = 0; k < @NAME@_COORDINATES; ++k)
        near.x[k] += step * dx[k];
    for (k = 0; k < @NAME@_DRIVERS; ++k)
        near.q[k] += step * along->q[k];
    for (k = 0; k < @NAME@_DESIGN; ++k)
        near.design[k] += step * along->design[k];
    @name@_prepare(near.design, s->work, s->geometry);
    @name@_motion(near.x, near.q, near.design, s->geometry, rest, rest, s->work, check, scratch);
    @name@_prepare(p->design, s->work, s->geometry);
    return fabs(check[4] - residual) <= @NAME@_MOST_DEFECT * @NAME@_NEARBY;
}
