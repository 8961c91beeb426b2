//! Progress of work, for a terminal or a page.

use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Receiver of progress reports other than a terminal: a page.
pub trait Listener: Send + Sync {
    /// Reports progress of a part of the work.
    fn progress(&self, what: &'static str, unit: &'static str, done: usize, of: usize);
    /// Reports an intermediate result as a line of text.
    fn line(&self, line: &str);
    /// Reports a failure: the diagnostics as JSON and as text.
    fn refused(&self, diagnostics: serde_json::Value, text: &str);
    /// Receives a result as a JSON document; only agents do.
    fn document(&self, _: serde_json::Value) {}
}

/// A progress bar, shown only on a terminal and after a delay; a listener receives the progress instead.
pub struct Meter {
    what: &'static str,
    unit: &'static str,
    started: Instant,
    bar: Option<ProgressBar>,
    listener: Option<Arc<dyn Listener>>,
    /// Amount done before the start, if the rate is shown.
    rate_after: Option<usize>,
}

impl Meter {
    /// Creates a meter for this work.
    pub fn new(what: &'static str, unit: &'static str, listener: Option<Arc<dyn Listener>>) -> Self {
        Self { what, unit, started: Instant::now(), bar: None, listener, rate_after: None }
    }

    /// Creates a meter for work of unknown length.
    pub fn working(what: &'static str, listener: Option<Arc<dyn Listener>>) -> Self {
        let mut meter = Self::new(what, "", listener);
        match &meter.listener {
            Some(listener) => listener.progress(what, "", 0, 0),
            None => {
                let bar =
                    ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()).with_message(what);
                if let Ok(style) = ProgressStyle::with_template("{spinner} {wide_msg}") {
                    bar.set_style(style);
                }
                bar.enable_steady_tick(Duration::from_millis(200));
                meter.bar = Some(bar);
            }
        }
        meter
    }

    /// Also shows the rate; `done` is the amount done before.
    pub fn with_rate(mut self, done: usize) -> Self {
        self.rate_after = Some(done);
        self
    }

    /// Shows the progress.
    pub fn show(&mut self, done: usize, total: usize) {
        const PATIENCE: Duration = Duration::from_millis(300);
        if let Some(listener) = &self.listener {
            listener.progress(self.what, self.unit, done, total);
            return;
        }
        if self.bar.is_none() && self.started.elapsed() > PATIENCE {
            let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::stderr());
            // The bar fills the rest of the line.
            let rate = self.rate_after.map_or("", |_| "{per_sec}, ");
            let template =
                format!("{} {{wide_bar}} {{pos}} of {{len}} {}, {rate}{{eta}} left", self.what, self.unit);
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style);
            }
            if let Some(before) = self.rate_after {
                bar.set_position(before as u64);
                bar.reset_eta();
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        }
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
