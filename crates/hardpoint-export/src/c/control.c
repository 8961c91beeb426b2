/* A correction below this (rad, or units of the coordinates) leaves an error of its square, which is round-off. */
#define @NAME@_QUADRATIC 1e-8
/* Most corrections of one move. */
#define @NAME@_MOST_CORRECTIONS 12
/* The first correction may be this fraction of the predicted move, ... */
#define @NAME@_TRUST 0.5
/* ... and is trusted below this, rad or units; a larger one may lead to another branch. */
#define @NAME@_TRUST_FLOOR 0.02
/* Longest move of a coordinate or driver that is taken at once, rad or units. */
#define @NAME@_LONGEST 0.5
/* A determinant may change by this factor in one move; near a singular position it changes by more. */
#define @NAME@_MILD 2.0
/* A singular position: the smallest pivot over the largest one. */
#define @NAME@_LEAST_PIVOT 1e-12
/* Largest factor of an elimination; a larger one loses digits. */
#define @NAME@_MOST_GROWTH 1e4
/* Largest residual of a constraint, rad or sizes of loops. */
#define @NAME@_MOST_RESIDUAL 1e-5
/* Shortest part of a path. */
#define @NAME@_SHORTEST (1.0 / 4096.0)

@tables@
static double @name@_greater(double a, double b)
{
    return a > b ? a : b;
}

@pieces@@prepare@/* Results at solved coordinates; counts the turns of angles from the position that is passed. */
static int @name@_results(@name@_position *p, @geometry_type@const double qd[], const double qdd[], double *w,
                          @name@_output *o)
{
    double check[@checks@];
    @name@_motion(p->x, p->q, @geometry@qd, qdd, w, check, o);
    o->residual = check[4];
    o->pivot_ratio = 1.0 / check[3];
    /* Comparisons are written so that NaN fails. */
    if (!(o->pivot_ratio > @NAME@_LEAST_PIVOT))
        return @NAME@_SINGULAR;
    if (!(check[1] <= 0.0))
        return @NAME@_BRANCH;
    if (!(check[0] <= 0.0) || !(check[2] <= @NAME@_MOST_GROWTH))
        return @NAME@_OUTSIDE;
    if (!(check[4] <= @NAME@_MOST_RESIDUAL))
        return @NAME@_LOCKED;
@measures@
    return @NAME@_OK;
}

/* Moves all drivers straight from the position to q, if that is near enough. On failure the position is changed. */
static int @name@_move(@name@_position *p, @geometry_type@const double q[], const double qd[], const double qdd[],
                       double *w, @name@_output *o)
{
    double line[@NAME@_DRIVERS], y[@outputs@], limit, moved = 0.0, travel = 0.0, size;
    const double rest[@NAME@_DRIVERS] = {0.0};
    int k, n, result;

    for (k = 0; k < @NAME@_DRIVERS; ++k) {
        line[k] = q[k] - p->q[k];
        travel = @name@_greater(travel, fabs(line[k]) / @name@_driver_unit[k]);
    }
    if (!(travel <= @NAME@_LONGEST))
        return @NAME@_TOO_FAR;
    if (travel > 0.0) {
        /* x + x' + x''/2 along the line from the last position */
        @name@_path(p->x, p->q, @geometry@line, rest, w, y);
        for (k = 0; k < @NAME@_COORDINATES; ++k) {
            const double step = y[2 * k] + 0.5 * y[2 * k + 1];
            p->x[k] += step;
            moved = @name@_greater(moved, fabs(step) / @name@_coordinate_unit[k]);
        }
@pieces_of_position@        if (!(moved <= @NAME@_LONGEST))
            return @NAME@_TOO_FAR;
    }
    for (k = 0; k < @NAME@_DRIVERS; ++k)
        p->q[k] = q[k];
    limit = @name@_greater(@NAME@_TRUST * moved, @NAME@_TRUST_FLOOR);
    for (n = 0;; ++n) {
        if (n == @NAME@_MOST_CORRECTIONS)
            return @NAME@_NOT_CONVERGED;
        @name@_correct(p->x, p->q, @geometry@w, y);
        o->corrections += 1;
        size = y[@NAME@_COORDINATES];
        if (!(size <= limit))
            return @NAME@_NOT_CONVERGED;
        for (k = 0; k < @NAME@_COORDINATES; ++k)
            p->x[k] = y[k];
@pieces_of_position@        if (size <= @NAME@_QUADRATIC)
            break;
        limit = 0.5 * size;
    }
    result = @name@_results(p, @g@qd, qdd, w, o);
    if (result != @NAME@_OK)
        return result;
    /* Every determinant changes little: no singular position is passed. */
    for (k = 0; k < @NAME@_BLOCKS; ++k) {
        const double now = p->determinant[k], before = p->determinant_before[k];
        const double ratio = @name@_logarithmic[k] ? exp(now - before) : now / before;
        if (!(ratio <= @NAME@_MILD && ratio * @NAME@_MILD >= 1.0))
            return @NAME@_SINGULAR;
        p->determinant_before[k] = now;
    }
    return @NAME@_OK;
}

void @name@_init(@name@_state *s)
{
@start@
}

/* Moves from the position straight to q@and_design@. */
static int @name@_travel(@name@_state *s, const double q[], const double qd[], const double qdd[],@design_type@
                         @name@_output *o)
{
    const @name@_position first = s->position;
    const double rest[@NAME@_DRIVERS] = {0.0};
    double done = 0.0, part = 1.0;
    int k, moves = 0, result;

    o->moves = 0;
    o->corrections = 0;
    for (k = 0; k < @NAME@_DRIVERS; ++k) {
        /* Infinity and NaN fail. */
        if (!(fabs(q[k]) + fabs(qd[k]) + fabs(qdd[k]) <= DBL_MAX))
            return @NAME@_NOT_FINITE;
    }
    for (;;) {
        const @name@_position before = s->position;
        const int is_last = done + part >= 1.0;
        double to[@NAME@_DRIVERS];
        for (k = 0; k < @NAME@_DRIVERS; ++k)
            to[k] = is_last ? q[k] : first.q[k] + (q[k] - first.q[k]) * (done + part);
        if (moves == @NAME@_MOST_MOVES) {
            s->position = first;
            result = @NAME@_TOO_FAR;
            break;
        }
        moves += 1;
        o->moves = moves;
@part_of_design@        result = @name@_move(&s->position, @state_geometry@to, is_last ? qd : rest, is_last ? qdd : rest,
                             s->work, o);
        if (result == @NAME@_OK) {
            if (is_last)
                return @NAME@_OK;
            done += part;
            part *= 2.0;
        } else {
            s->position = before;
            part *= 0.5;
            if (part < @NAME@_SHORTEST) {
                s->position = first;
                break;
            }
        }
    }
@restore_design@    return result;
}

int @name@_step(@name@_state *s, const double q[], const double qd[], const double qdd[], @name@_output *o)
{
    return @name@_travel(s, q, qd, qdd,@no_design@ o);
}
