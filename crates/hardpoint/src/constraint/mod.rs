//! The paper's elementary constraints, one file each, as residuals and wrenches.
//!
//! Each constraint row acts between marker i and marker j. Its wrench `l` gives the rate of the residual for any twists
//! W of the two markers, `d(phi) = l . (W_j - W_i)` (`docs/theory.md` (5)). Jacobian, velocity, acceleration and all
//! sensitivities are computed from `l` and its first two time derivatives.
//!
//! | here | theory, section 2 | paper |
//! |---|---|---|
//! | `ends.i`, `ends.j` | markers `X_i M_i`, `X_j M_j`: P_i, P_j and axes a_i, b_j | x"-y"-z" frames; `r + A s`, `A C a"` (4.2, 4.5) |
//! | `target` | what a row keeps, and f of its driver | C of (4.10) |
//! | `residual` | phi | phi of (4.1), (4.4), (4.7), (4.10) |
//! | `wrench` | l, on a twist of j; its opposite on one of i | a row of `phi_z` (5.3a) |
//! | `wrench_rates` | l., l.. | |

mod angle;
mod convel;
mod distance;
mod dot1;
mod dot2;
mod lowest_point;
mod marker_pair;
mod row;
mod spherical;

pub use lowest_point::Radius;
pub use marker_pair::{MarkerPair, MarkerPairRates};
use marker_pair::{axis, cross_rates, direction_rates, force_rates, point_rates};
pub use row::Row;
pub(crate) use row::{COINCIDE, ON_LINE, PARALLEL_FRAMES, PARALLEL_Z};
