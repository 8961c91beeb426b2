//! Picture of the mechanism.

use hardpoint_report::sketch::{SIZE as PICTURE, Stroke};

use super::paper::{BLACK, GREY, PAGE, PALE, Paper, RED, WHITE};

/// Size of the picture of the mechanism, relative to its own.
const PICTURE_SCALE: f32 = 1.15;
/// Radius of a joint in it, and its number of corners.
const PIN: (f32, f32) = (3.4, 24.0);

/// Draws the mechanism.
pub(super) fn picture(paper: &mut Paper, strokes: &[Stroke]) {
    if strokes.is_empty() {
        return;
    }
    let [width, height] = PICTURE.map(|size| size as f32 * PICTURE_SCALE);
    paper.need(height);
    paper.y -= height;
    let (left, bottom) = ((PAGE.0 - width) / 2.0, paper.y);
    let place =
        |[x, y]: [f64; 2]| [left + x as f32 * PICTURE_SCALE, bottom + height - y as f32 * PICTURE_SCALE];
    let all = |points: &[[f64; 2]]| points.iter().map(|p| place(*p)).collect::<Vec<_>>();
    for stroke in strokes {
        match stroke {
            Stroke::Body(points) => paper.shape(PALE, BLACK, 2.4, &all(points)),
            Stroke::Guide(points) => paper.lines(GREY, 0.9, all(points)),
            Stroke::Path(points) => paper.lines(RED, 1.6, all(points)),
            Stroke::Block(points) => paper.shape(WHITE, BLACK, 1.4, &all(points)),
            Stroke::Pin(at, is_grounded) => {
                let [x, y] = place(*at);
                let corner = |k: u8| {
                    let (sin, cos) = (std::f32::consts::TAU * f32::from(k) / PIN.1).sin_cos();
                    [x + PIN.0 * cos, y + PIN.0 * sin]
                };
                let fill = if *is_grounded { BLACK } else { WHITE };
                paper.shape(fill, BLACK, 1.3, &(0..PIN.1 as u8).map(corner).collect::<Vec<_>>());
            }
        }
    }
}
