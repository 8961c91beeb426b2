//! Files of other programs become models that run.
mod try_it;
