    {
        int k;
        for (k = 0; k < @NAME@_MEASURES; ++k) {
            @name@_measure_value *m = &d->measure[k];
            /* What is undefined has no derivative. */
            if (!(fabs(o->measure[k].value) <= DBL_MAX))
                m->value = NAN;
            if (!(fabs(o->measure[k].rate) <= DBL_MAX))
                m->rate = NAN;
            if (!(fabs(o->measure[k].acceleration) <= DBL_MAX))
                m->acceleration = NAN;
        }
    }
