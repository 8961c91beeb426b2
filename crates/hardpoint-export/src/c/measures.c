static const int @name@_formula[] = {@formulas@}; /* measures that are formulas */
static const int @name@_counted[] = {@counted@}; /* measures that count whole turns */

/* Evaluates the formulas, counts whole turns from the last position, and marks what is undefined. */
static void @name@_measure(@name@_position *p, @geometry_type@double *w, @name@_output *o)
{
    const double turn = 6.283185307179586;
    double guard[@NAME@_MEASURES];
    int differ, k, pass;

    /* Formulas may use angles with their turns, so these are found first. */
    for (pass = 0; pass < 2; ++pass) {
        @name@_formulas(p, @geometry@w, guard, o);
        differ = 0;
        for (k = 0; k < @counters@; ++k) {
            const double now = o->measure[@name@_counted[k]].value;
            const double whole = turn * rint((p->angle[k] - now) / turn);
            if (fabs(whole) <= DBL_MAX && fabs(whole - p->turn[k]) > 1.0) {
                p->turn[k] = whole;
                differ = 1;
            }
        }
        if (!differ)
            break;
    }
    for (k = 0; k < @counters@; ++k) {
        @name@_measure_value *m = &o->measure[@name@_counted[k]];
        m->value += p->turn[k];
        if (fabs(m->value) <= DBL_MAX)
            p->angle[k] = m->value;
    }
    for (k = 0; k < @formula_count@; ++k) {
        @name@_measure_value *m = &o->measure[@name@_formula[k]];
        if (!(guard[@name@_formula[k]] <= 0.0))
            m->value = m->rate = m->acceleration = NAN;
    }
}

