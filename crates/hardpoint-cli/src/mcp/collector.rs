//! Collector of the progress of a tool.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::meter::Listener;
use crate::rpc::Output;

/// Minimum interval between two progress notifications.
const PACE: Duration = Duration::from_millis(100);

/// Receiver of the reports of a tool.
pub(crate) struct Collector {
    output: Output,
    token: Option<Value>,
    /// Time and amount of the last notification.
    last: Mutex<(Option<Instant>, f64)>,
    documents: Mutex<Vec<Value>>,
    refusals: Mutex<Vec<String>>,
}

impl Collector {
    pub(super) fn new(output: Output, token: Option<Value>) -> Self {
        Self {
            output,
            token,
            last: Mutex::new((None, 0.0)),
            documents: Mutex::default(),
            refusals: Mutex::default(),
        }
    }

    /// Results of the command.
    pub fn documents(&self) -> Vec<Value> {
        std::mem::take(&mut *locked(&self.documents))
    }

    /// Errors of the command, as text.
    pub fn refusals(&self) -> Vec<String> {
        std::mem::take(&mut *locked(&self.refusals))
    }

    /// Reports progress, which must increase.
    fn notify(&self, done: f64, total: Option<usize>, message: &str) {
        let Some(token) = &self.token else { return };
        let mut last = locked(&self.last);
        if last.0.is_some_and(|at| at.elapsed() < PACE) || done <= last.1 {
            return;
        }
        *last = (Some(Instant::now()), done);
        let mut params = json!({ "progressToken": token, "progress": done, "message": message });
        if let Some(total) = total {
            params["total"] = total.into();
        }
        self.output.notify("notifications/progress", &params);
    }
}

impl Listener for Collector {
    fn progress(&self, what: &'static str, unit: &'static str, done: usize, of: usize) {
        let message = format!("{what}: {done} of {of} {unit}");
        self.notify(done as f64, Some(of).filter(|of| *of > 0), message.trim_end());
    }

    fn line(&self, line: &str) {
        let next = locked(&self.last).1 + 1.0;
        self.notify(next, None, &anstream::adapter::strip_str(line).to_string());
    }

    fn refused(&self, _: Value, text: &str) {
        locked(&self.refusals).push(text.to_owned());
    }

    fn document(&self, document: Value) {
        locked(&self.documents).push(document);
    }
}

pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
