//! Notes that are not warnings: idle rotations, laws with jumps, distance from the origin.

use hardpoint::joint::Quantity;
use hardpoint::law::Jump;
use hardpoint::model::{Driver, Model};
use hardpoint_file::Units;

use crate::figures::{names, number, order_unit, rounded, symbol, with_unit};

/// One note per idle rotation.
pub(super) fn idle_spins(model: &Model) -> Vec<String> {
    let note = |idle: &hardpoint::model::IdleRotation| {
        let bodies = names(idle.bodies.iter().map(|b| model.bodies[b.0].name.as_str()));
        let ball = &model.joints[idle.joint.0].name;
        let (spins, its) = match idle.bodies.len() {
            1 => ("can spin about its own axis", "its"),
            _ => ("can spin together about their common axis", "their"),
        };
        format!(
            "{bodies} {spins} without moving anything else; {its} spin is held at rest (the ball `{ball}` is treated as \
             a universal joint)"
        )
    };
    model.idle.iter().map(note).collect()
}

/// One note per driver and per order of derivative that jumps during the run.
pub(super) fn jumps(model: &Model, units: Units) -> Vec<String> {
    let (Some(&start), Some(&end)) = (model.times.first(), model.times.last()) else { return Vec::new() };
    let of_driver = |driver: &Driver| {
        let jumps = driver.law.jumps(start, end);
        let of_order = |order: usize| jumps.iter().filter(|j| j.order == order).copied().collect::<Vec<_>>();
        let notes: Vec<String> = (0..3)
            .map(|order| (order, of_order(order)))
            .filter(|(_, jumps)| !jumps.is_empty())
            .map(|(order, jumps)| jump_note(model, units, driver, order, &jumps))
            .collect();
        notes
    };
    model.drivers.iter().flat_map(of_driver).collect()
}

/// Distance from the origin, in sizes of the mechanism, at which four digits are lost in the coordinates.
const FAR: f64 = 1e4;

/// Note on a mechanism that is far from the origin.
pub(super) fn far_away(model: &Model, units: Units) -> Option<String> {
    let (distance, size) = (model.distance_from_origin(), model.size());
    let lost = (distance / size).log10();
    (distance > FAR * size).then(|| {
        let unit = symbol(units, Quantity::Length);
        let length = |x: f64| format!("{} {unit}", rounded(units.from_si(Quantity::Length, x), 3));
        format!(
            "the joints lie {} from the origin, in a mechanism of {}: numbers have 16 digits, and about {lost:.0} of them go into that \
             distance; move the origin nearer",
            length(distance),
            length(size)
        )
    })
}

fn jump_note(model: &Model, units: Units, driver: &Driver, order: usize, jumps: &[Jump]) -> String {
    const SHOWN: usize = 3;
    let quantity = model.driven(driver).quantity;
    let unit = order_unit(units, quantity, order);
    let one = |j: &Jump| {
        let size = with_unit(units.from_si(quantity, j.size), &unit);
        format!("by {size} at t = {} s", number(j.time))
    };
    let shown: Vec<String> = jumps.iter().take(SHOWN).map(one).collect();
    let more = match jumps.len().saturating_sub(SHOWN) {
        0 => String::new(),
        n => format!(", and {n} more"),
    };
    let (what, so) = [
        (
            "law",
            "the mechanism would have to be in two places at once; positions and all that follows from them jump there",
        ),
        (
            "speed of the law",
            "velocities and their sensitivities jump there, and the acceleration at that moment would be infinite",
        ),
        ("acceleration of the law", "accelerations and their sensitivities jump there"),
    ][order];
    format!("the {what} of `{}` jumps {}{more}: {so}", driver.name, shown.join(", "))
}
