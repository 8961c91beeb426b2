//! What is wanted: points to follow, measures, output times.

use hardpoint::model::{
    AngleKindDraft, AxleMeasure, Line, MeasureDraft, MeasureKindDraft, MetricDraft, Place, PointDraft,
    PointRef, RayDraft, Section, Take, WheelMeasure,
};
use hardpoint::space::Vec3;

use super::Raw;
use crate::places::EntryPlace;
use crate::tree::{Field, Fields, Key, Reader, Subject, Value};

/// More output times than this are surely a slip.
const MOST_TIMES: usize = 1_000_000;
const POINT: &[Key] = &[("body", "\"crank\""), ("at", "\"A\"")];
const TIME: &[Key] = &[("start", "0"), ("end", "1.0"), ("steps", "100"), ("at", "[0, 0.5, 1]")];
const COORDINATE: &[Key] = &[("type", "\"coordinate\""), ("joint", "\"J1\""), ("coordinate", "\"angle\"")];
const DISTANCE: &[Key] = &[("type", "\"distance\""), ("from", "\"P\""), ("to", "\"Q\"")];
const POSITION: &[Key] = &[("type", "\"position\""), ("point", "\"P\""), ("along", "\"z\"")];
const ANGLE: &[Key] = &[
    ("type", "\"angle\""),
    ("from", "[\"P\", \"Q\"]"),
    ("to", "{ body = \"rocker\", axis = \"x\" }"),
    ("about", "\"z\""),
];
const TRANSMISSION: &[Key] =
    &[("type", "\"transmission_angle\""), ("from", "[\"P\", \"Q\"]"), ("to", "[\"Q\", \"R\"]")];
const RAY: &[Key] = &[("body", "\"rocker\""), ("axis", "\"x\"")];
const VELOCITY: &[Key] = &[("type", "\"velocity\""), ("point", "\"P\""), ("along", "\"x\"")];
const CURVATURE: &[Key] = &[("type", "\"curvature\""), ("point", "\"P\""), ("about", "\"z\"")];
const RATE: &[Key] = &[("type", "\"rate\""), ("of", "\"toe\"")];
const SLOPE: &[Key] =
    &[("type", "\"slope\""), ("of", "\"spring\""), ("over", "\"P.z\""), ("driver", "\"bump\"")];
const EXPRESSION: &[Key] = &[("type", "\"expression\""), ("expression", "\"left.toe + right.toe\"")];
const AXLE: &[Key] = &[("type", "\"track\""), ("axle", "\"front\"")];
const WHEEL: &[Key] = &[("type", "\"caster\""), ("wheel", "\"front_left\"")];
const METRIC: &[Key] = &[
    ("of", "\"toe\""),
    ("take", "\"max\""),
    ("over", "\"wheel_travel\""),
    ("at", "0"),
    ("window", "[-20, 20]"),
    ("target", "[[-50, 0.1], [50, -0.1]]"),
];
/// Types of measures but for those of wheels and axles.
const OWN: [&str; 11] = [
    "coordinate",
    "distance",
    "position",
    "angle",
    "transmission_angle",
    "velocity",
    "acceleration",
    "curvature",
    "rate",
    "slope",
    "expression",
];
const TOE: &[Key] =
    &[("type", "\"toe\""), ("wheel", "\"front_left\""), ("body", "\"knuckle\""), ("spin_axis", "[0, 1, 0]")];
const MEASURE: &[Key] = &[("type", "\"coordinate\"")];

impl Reader<'_> {
    pub(super) fn points(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "points", "point") {
            let fields = self.entry("point", &entry, POINT);
            let mut place = EntryPlace::of(&fields);
            let body = self.named(&fields, "body", "the name of a body", &mut place).unwrap_or_default();
            let at = self.need(&fields, "at").and_then(|f| self.place(f.value, &fields.subject("at")));
            place.items("at", Vec::new());
            let at = at.unwrap_or_else(|| {
                place.unread("at");
                Place::At(Vec3::ZERO)
            });
            raw.places.push(Section::Points, place);
            raw.draft.points.push(PointDraft { name: entry.0, body, at });
        }
    }

    pub(super) fn measures(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let of_wheels = WheelMeasure::ALL.iter().map(|m| m.name());
        let of_axles = AxleMeasure::ALL.iter().map(|m| m.name());
        let types: Vec<_> = OWN.into_iter().chain(of_wheels).chain(of_axles).collect();
        for entry in self.entries(model, "measures", "measure") {
            let Some(kind) = self.entry_type("measure", &entry, &types, MEASURE) else { continue };
            let keys = match kind {
                "coordinate" => COORDINATE,
                "distance" => DISTANCE,
                "position" => POSITION,
                "angle" => ANGLE,
                "transmission_angle" => TRANSMISSION,
                "velocity" | "acceleration" => VELOCITY,
                "curvature" => CURVATURE,
                "rate" => RATE,
                "slope" => SLOPE,
                "expression" => EXPRESSION,
                "toe" | "camber" => TOE,
                _ if AxleMeasure::named(kind).is_some() => AXLE,
                _ => WHEEL,
            };
            let fields = self.entry("measure", &entry, keys);
            let mut place = EntryPlace::of(&fields);
            if let Some(kind) = self.measure(kind, &fields, &mut place) {
                raw.places.push(Section::Measures, place);
                raw.draft.measures.push(MeasureDraft { name: entry.0, kind });
            }
        }
    }

    fn measure(
        &mut self,
        kind: &str,
        fields: &Fields<'_>,
        place: &mut EntryPlace,
    ) -> Option<MeasureKindDraft> {
        match kind {
            "coordinate" => {
                let joint = self.named(fields, "joint", "the name of a joint", place);
                let coordinate = self.optional_name(fields, "coordinate", "the name of a coordinate", place);
                Some(MeasureKindDraft::Coordinate { joint: joint?, coordinate })
            }
            "distance" => {
                let [from, to] =
                    ["from", "to"].map(|key| self.need(fields, key).and_then(|f| self.point_ref(fields, f)));
                Some(MeasureKindDraft::Distance { from: from?, to: to? })
            }
            "position" => {
                let point = self.need(fields, "point").and_then(|f| self.point_ref(fields, f));
                let along =
                    self.need(fields, "along").and_then(|f| self.vector(f.value, &fields.subject("along")));
                Some(MeasureKindDraft::Coordinates { point: point?, along: along? })
            }
            "angle" | "transmission_angle" => {
                let [from, to] =
                    ["from", "to"].map(|key| self.need(fields, key).and_then(|f| self.ray(fields, f, place)));
                let about = self.vector_if_any(fields, "about")?;
                let kind = match (kind, about) {
                    ("angle", Some(about)) => AngleKindDraft::About(about),
                    ("angle", None) => AngleKindDraft::Between,
                    _ => AngleKindDraft::Lines,
                };
                Some(MeasureKindDraft::Angle { between: [from?, to?], kind })
            }
            "velocity" | "acceleration" => {
                let point = self.need(fields, "point").and_then(|f| self.point_ref(fields, f));
                let along = self.vector_if_any(fields, "along")?;
                let order = if kind == "velocity" { 1 } else { 2 };
                Some(MeasureKindDraft::Velocity { point: point?, along, order })
            }
            "curvature" => {
                let point = self.need(fields, "point").and_then(|f| self.point_ref(fields, f));
                let about = self.vector_if_any(fields, "about")?;
                Some(MeasureKindDraft::Curvature { point: point?, about })
            }
            "rate" => {
                let of = self.named(fields, "of", "the name of a measure", place);
                Some(MeasureKindDraft::Rate { of: of? })
            }
            "slope" => {
                let [of, over] =
                    ["of", "over"].map(|key| self.named(fields, key, "the name of a measure", place));
                let driver = self.optional_name(fields, "driver", "the name of a driver", place);
                Some(MeasureKindDraft::Slope { of: of?, over: over?, driver })
            }
            "expression" => {
                let f = self.need(fields, "expression")?;
                let subject = fields.subject("expression");
                if f.value.get_ref().as_str().is_none() {
                    self.wrong(f.value, &subject, "an expression in quotes");
                }
                let expression = self.expression(f.value, &subject)?;
                Some(MeasureKindDraft::Combination { expression })
            }
            _ if AxleMeasure::named(kind).is_some() => {
                let axle = self.named(fields, "axle", "the name of an axle", place);
                let what = AxleMeasure::named(kind).expect("just found");
                Some(MeasureKindDraft::Axle { axle: axle?, what })
            }
            "toe" | "camber" if fields.get("body").is_some() || fields.get("spin_axis").is_some() => {
                self.out_of_place(fields, "wheel", "`body` and `spin_axis` say of which wheel already");
                let body = self.named(fields, "body", "the name of a body", place);
                let spin_axis = self.need(fields, "spin_axis").and_then(|f| self.line_of(fields, f, place));
                let (body, spin_axis) = (body?, spin_axis?);
                Some(match kind {
                    "toe" => MeasureKindDraft::Toe { body, spin_axis },
                    _ => MeasureKindDraft::Camber { body, spin_axis },
                })
            }
            _ => {
                let wheel = self.named(fields, "wheel", "the name of a wheel", place);
                let what = WheelMeasure::named(kind).expect("the other types are those of wheels");
                Some(MeasureKindDraft::Wheel { wheel: wheel?, what })
            }
        }
    }

    /// A vector that may be left out; `None` where it is there and none.
    fn vector_if_any(&mut self, fields: &Fields<'_>, key: &str) -> Option<Option<Vec3>> {
        match fields.get(key) {
            Some(f) => self.vector(f.value, &fields.subject(key)).map(Some),
            None => Some(None),
        }
    }

    /// A direction to measure an angle from or to: `["P", "Q"]`, a global vector, or `{ body = ..., axis = ... }`.
    fn ray(&mut self, fields: &Fields<'_>, f: Field<'_>, place: &mut EntryPlace) -> Option<RayDraft> {
        let subject = fields.subject(f.key);
        if let Some(table) = f.value.get_ref().as_table() {
            let fields = self.fields(subject.name.clone(), f.value.span(), table, RAY);
            let body = self.required(&fields, "body", "the name of a body");
            let axis = self.need(&fields, "axis").and_then(|f| self.line_of(&fields, f, place));
            return Some(RayDraft::Fixed { body: body?, axis: axis? });
        }
        let is_number =
            |v: &Value<'_>| v.get_ref().as_integer().is_some() || v.get_ref().as_float().is_some();
        match f.value.get_ref().as_array() {
            Some(list) if list.len() == 2 && !list.iter().any(is_number) => {
                let [a, b] = [0, 1].map(|k| self.point_ref(fields, Field { value: &list[k], ..f }));
                Some(RayDraft::Between([a?, b?]))
            }
            _ => {
                let axis = self.vector(f.value, &subject)?;
                Some(RayDraft::Fixed { body: "ground".into(), axis: Line::Along(axis) })
            }
        }
    }

    pub(super) fn metrics(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        for entry in self.entries(model, "metrics", "metric") {
            let fields = self.entry("metric", &entry, METRIC);
            let mut place = EntryPlace::of(&fields);
            let of = self.named(&fields, "of", "the name of a measure", &mut place);
            let over = self.optional_name(&fields, "over", "the name of a measure", &mut place);
            let take = self.take(&fields);
            let window = fields.get("window").map(|f| {
                self.numbers::<2>(f.value, &fields.subject("window"), "the lower and the upper end")
            });
            if let (Some(of), Some(take), true) = (of, take, window != Some(None)) {
                let (per_metre, per_radian) = (self.units.length.per_metre(), self.units.angle.per_radian());
                let window = window.flatten();
                raw.places.push(Section::Metrics, place);
                raw.draft.metrics.push(MetricDraft {
                    name: entry.0,
                    of,
                    over,
                    take,
                    window,
                    per_metre,
                    per_radian,
                });
            }
        }
    }

    /// What a metric takes, in the file's units.
    fn take(&mut self, fields: &Fields<'_>) -> Option<Take> {
        let f = self.need(fields, "take")?;
        let subject = fields.subject("take");
        let word = self.name(f.value, &subject, "what to take of the curve")?;
        if word != "rms" {
            self.out_of_place(fields, "target", "only `take = \"rms\"` compares with a target");
        }
        if word != "value" && word != "slope" {
            self.out_of_place(fields, "at", "only `take = \"value\"` and `\"slope\"` are taken at one place");
        } else {
            self.out_of_place(fields, "window", "it is taken at one place");
        }
        Some(match word.as_str() {
            "min" => Take::Least,
            "max" => Take::Greatest,
            "range" => Take::Range,
            "mean" => Take::Mean,
            "rms" => Take::Rms(match fields.get("target") {
                Some(f) => self.pairs(f.value, &fields.subject("target"))?,
                None => Vec::new(),
            }),
            "value" => Take::Value(self.needed_number(fields, "at")?),
            "slope" => Take::Slope(self.needed_number(fields, "at")?),
            _ => {
                self.unknown_word(f.value.span(), &subject, &word, &Take::NAMES);
                return None;
            }
        })
    }

    /// A list of pairs of numbers.
    fn pairs(&mut self, value: &Value<'_>, subject: &Subject) -> Option<Vec<[f64; 2]>> {
        let expected = "a list of points `[abscissa, value]`";
        let list = self.list(value, subject, expected)?;
        list.iter().map(|pair| self.numbers::<2>(pair, subject, expected)).collect()
    }

    pub(super) fn point_ref(&mut self, fields: &Fields<'_>, f: Field<'_>) -> Option<PointRef> {
        let subject = fields.subject(f.key);
        let Some(table) = f.value.get_ref().as_table() else {
            return self
                .name(f.value, &subject, "a point's name or `{ body = ..., at = ... }`")
                .map(PointRef::Named);
        };
        let fields = self.fields(subject.name.clone(), f.value.span(), table, POINT);
        let body = self.required(&fields, "body", "the name of a body");
        let at = self.need(&fields, "at").and_then(|f| self.place(f.value, &fields.subject("at")));
        Some(PointRef::On { body: body?, at: at? })
    }

    pub(super) fn time(&mut self, model: &Fields<'_>, raw: &mut Raw) {
        let Some(f) = model.get("time") else { return };
        let mut place = EntryPlace::at(f.value.span());
        let times = self.times(model, f);
        if times.is_none() {
            place.unread("");
        }
        raw.draft.times = times.unwrap_or_default();
        raw.places.push(Section::Time, place);
    }

    fn times(&mut self, model: &Fields<'_>, f: Field<'_>) -> Option<Vec<f64>> {
        let table = self.table(f.value, &model.subject("time"), "a table with `end` and `steps`")?;
        let fields = self.fields("`time`", f.value.span(), table, TIME);
        if let Some(f) = fields.get("at") {
            for key in ["start", "end", "steps"] {
                self.out_of_place(&fields, key, "the output times are listed in `at` already");
            }
            let subject = fields.subject("at");
            let Some(list) = f.value.get_ref().as_array().filter(|list| !list.is_empty()) else {
                self.wrong(f.value, &subject, "a list of times in s");
                return None;
            };
            if list.len() > MOST_TIMES {
                self.senseless(f.value.span(), format!("there are more than {MOST_TIMES} output times"));
                return None;
            }
            let times: Vec<_> = list.iter().map(|v| self.number(v, &subject)).collect();
            let times: Vec<f64> = times.into_iter().collect::<Option<_>>()?;
            if let Some(k) = (1..times.len()).find(|&k| times[k] <= times[k - 1]) {
                let message = format!("the output time {} s comes after {} s", times[k], times[k - 1]);
                self.senseless(list[k].span(), message).help =
                    Some("list the times in increasing order".into());
                return None;
            }
            return Some(times);
        }
        let start = match fields.get("start") {
            Some(f) => self.number(f.value, &fields.subject("start")),
            None => Some(0.0),
        };
        let end_field = self.need(&fields, "end");
        let end = end_field.and_then(|f| self.number(f.value, &fields.subject("end")));
        let steps_field = self.need(&fields, "steps");
        let steps = steps_field.and_then(|f| {
            let steps = self.number(f.value, &fields.subject("steps"))?;
            if !(steps >= 1.0 && steps <= MOST_TIMES as f64 && steps.fract() == 0.0) {
                let message = format!("`steps` of `time` cannot be {steps}");
                self.senseless(f.value.span(), message).help =
                    Some(format!("give the number of intervals, a whole number from 1 to {MOST_TIMES}"));
                return None;
            }
            Some(steps as usize)
        });
        let (start, end, steps) = (start?, end?, steps?);
        if end <= start {
            let at = end_field.map_or(fields.at.clone(), |f| f.value.span());
            let message = format!("the motion ends at {end} s, before it starts at {start} s");
            self.senseless(at, message).help =
                Some("give an `end` after `start` (which is 0 if it is left out)".into());
            return None;
        }
        Some((0..=steps).map(|k| start + (end - start) * k as f64 / steps as f64).collect())
    }
}
