//! Response times against the server's clock.

/// What clocks may differ by, in µs.
const ALLOWANCE_US: i64 = 500_000;

/// What a session's answers claim of time, and when they came. Trials are taken one after the other, so that answers which came by some moment
/// need all of their response times between consent and that moment. Whatever came later than it was given (kept while the line was down, and
/// sent together) breaks no such bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pace {
    /// Response times so far, in µs.
    claimed_us: i64,
    /// The latest time at which the first trial can have begun, if all that is claimed is true.
    latest_start_us: Option<i64>,
    lacks_a_time: bool,
    is_hurried: bool,
    /// The first and the last answer that came.
    ends: Option<[Step; 2]>,
}

/// An answer that came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Step {
    trial_index: u16,
    /// Whether its trial was decided by the answer before.
    is_decided: bool,
    claimed_us: i64,
    received_us: i64,
}

impl Step {
    /// Whether a trial that is decided by this answer can't have been seen before it came, and was answered in less than it claims.
    fn is_too_soon_for(&self, next: &Step) -> bool {
        let decides = self.is_decided && next.is_decided && self.trial_index + 1 == next.trial_index;
        decides && next.received_us - self.received_us + ALLOWANCE_US < next.claimed_us
    }
}

impl Pace {
    /// Of one answer: how long it claims to have taken, when the server received it, and whether answers decide which trials come.
    pub fn of(trial_index: u16, is_decided: bool, rt_ms: f64, received_us: Option<i64>) -> Pace {
        let is_time = rt_ms.is_finite() && rt_ms >= 0.0;
        // A browser's clock may run a hundredth too fast.
        let claimed_us = if is_time { (rt_ms * 990.0) as i64 } else { 0 };
        let step = received_us.map(|received_us| Step { trial_index, is_decided, claimed_us, received_us });
        Pace {
            claimed_us,
            latest_start_us: received_us.map(|received| received.saturating_sub(claimed_us)),
            lacks_a_time: !is_time,
            is_hurried: false,
            ends: step.map(|step| [step, step]),
        }
    }

    /// Of these answers and those that came later.
    pub fn then(self, later: Pace) -> Pace {
        let latest = later.latest_start_us.map(|start| start.saturating_sub(self.claimed_us));
        let hurried =
            self.ends.zip(later.ends).is_some_and(|([_, last], [first, _])| last.is_too_soon_for(&first));
        Pace {
            claimed_us: self.claimed_us.saturating_add(later.claimed_us),
            latest_start_us: [self.latest_start_us, latest].into_iter().flatten().min(),
            lacks_a_time: self.lacks_a_time || later.lacks_a_time,
            is_hurried: self.is_hurried || later.is_hurried || hurried,
            ends: match (self.ends, later.ends) {
                (Some([first, _]), Some([_, last])) => Some([first, last]),
                (one, other) => one.or(other),
            },
        }
    }

    /// Whether the answers claim more time than there was.
    pub fn is_faster_than_clock(&self, consented_us: Option<i64>) -> bool {
        let before =
            |start: i64| consented_us.is_some_and(|consented| start.saturating_add(ALLOWANCE_US) < consented);
        self.is_hurried || self.latest_start_us.is_some_and(before)
    }

    /// Whether an answer came without a response time that can be.
    pub fn lacks_a_time(&self) -> bool {
        self.lacks_a_time
    }
}
