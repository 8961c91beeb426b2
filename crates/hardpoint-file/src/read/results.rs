//! What is wanted: points to follow, measures, output times.

use hardpoint::model::{MeasureDraft, MeasureKindDraft, Place, PointDraft, PointRef, Section, WheelMeasure};
use hardpoint::space::Vec3;

use super::Raw;
use crate::places::EntryPlace;
use crate::tree::{Field, Fields, Key, Reader};

/// More output times than this are surely a slip.
const MOST_TIMES: usize = 1_000_000;
const POINT: &[Key] = &[("body", "\"crank\""), ("at", "\"A\"")];
const TIME: &[Key] = &[("start", "0"), ("end", "1.0"), ("steps", "100"), ("at", "[0, 0.5, 1]")];
const COORDINATE: &[Key] = &[("type", "\"coordinate\""), ("joint", "\"J1\""), ("coordinate", "\"angle\"")];
const DISTANCE: &[Key] = &[("type", "\"distance\""), ("from", "\"P\""), ("to", "\"Q\"")];
const POSITION: &[Key] = &[("type", "\"position\""), ("point", "\"P\""), ("along", "\"z\"")];
const WHEEL: &[Key] = &[("type", "\"caster\""), ("wheel", "\"front_left\"")];
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
        let types: Vec<_> = ["coordinate", "distance", "position"].into_iter().chain(of_wheels).collect();
        for entry in self.entries(model, "measures", "measure") {
            let Some(kind) = self.entry_type("measure", &entry, &types, MEASURE) else { continue };
            let keys = match kind {
                "coordinate" => COORDINATE,
                "distance" => DISTANCE,
                "position" => POSITION,
                "toe" | "camber" => TOE,
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
