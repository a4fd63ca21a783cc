//! The one writer: a thread with a connection of its own. It commits all that has queued in one go, then acknowledges it.
//!
//! One sync serves as many answers as came while the one before was under way. A job that fails is rolled back alone. Where SQLite or the
//! disk fails, nobody knows what state the connection is in: the whole group is refused, and the next one gets a connection opened anew.

use crate::error::{StoreError, Trouble};
use crate::place::Place;
use rusqlite::Connection;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use tokio::sync::oneshot;

/// Jobs that are committed together: a slow disk gathers more, and none of them waits for thousands of others.
const MOST_JOBS: usize = 256;

/// Why a job is rolled back.
pub(crate) enum Refused<E> {
    /// The database failed or refused.
    Store(StoreError),
    /// What the caller was asked in between failed.
    Caller(E),
}

impl<E, S: Into<StoreError>> From<S> for Refused<E> {
    fn from(error: S) -> Self {
        Refused::Store(error.into())
    }
}

/// The way to the writer's thread, which ends when the last of these is gone.
#[derive(Clone, Debug)]
pub(crate) struct Writer {
    queue: Sender<Message>,
}

enum Message {
    Job(Box<dyn Job>),
    Close(oneshot::Sender<()>),
}

impl Writer {
    /// Starts the thread; `open` opens its connection to the database at `place`, again after each failure.
    pub(crate) fn start(
        place: Place,
        open: impl Fn() -> Result<Connection, StoreError> + Send + 'static,
    ) -> Result<Writer, StoreError> {
        let (queue, messages) = channel();
        let thread = std::thread::Builder::new().name("kelir-writer".to_owned());
        let started = thread.spawn(move || work(&messages, &place, &open));
        started.map_err(|error| StoreError::trouble(Trouble::Failing, error))?;
        Ok(Writer { queue })
    }

    /// Runs a job in the next transaction. When this returns `Ok`, that is committed and synced.
    pub(crate) async fn run<T: Send + 'static, E: From<StoreError> + Send + 'static>(
        &self,
        job: impl FnOnce(&Connection) -> Result<T, Refused<E>> + Send + 'static,
    ) -> Result<T, E> {
        let (reply, answer) = oneshot::channel();
        let task = Task { job: Some(job), result: None, reply };
        // Whether it was taken or not: an answer that does not come says the same.
        let _ = self.queue.send(Message::Job(Box::new(task)));
        answer.await.unwrap_or_else(|_| Err(ended().into()))
    }

    /// Ends the thread after what has queued.
    pub(crate) async fn close(&self) {
        let (done, closed) = oneshot::channel();
        let _ = self.queue.send(Message::Close(done));
        // An error means that it has ended already.
        let _ = closed.await;
    }
}

fn ended() -> StoreError {
    StoreError::trouble(Trouble::Failing, "the writer has ended")
}

/// What a job came to, before its group is committed.
enum Outcome {
    Done,
    RolledBack,
    /// Nobody else of the group can be committed either.
    Failed(StoreError),
}

/// Something to write and somebody who waits for it.
trait Job: Send {
    fn run(&mut self, connection: &Connection) -> Outcome;
    /// Tells whoever waits: what came of the job, or why its group was not committed.
    fn settle(self: Box<Self>, committed: Result<(), StoreError>);
}

struct Task<J, T, E> {
    job: Option<J>,
    result: Option<Result<T, E>>,
    reply: oneshot::Sender<Result<T, E>>,
}

impl<J, T, E> Job for Task<J, T, E>
where
    J: FnOnce(&Connection) -> Result<T, Refused<E>> + Send,
    T: Send,
    E: From<StoreError> + Send,
{
    fn run(&mut self, connection: &Connection) -> Outcome {
        let Some(job) = self.job.take() else { return Outcome::RolledBack };
        let (outcome, result) = match job(connection) {
            Ok(value) => (Outcome::Done, Ok(value)),
            Err(Refused::Caller(error)) => (Outcome::RolledBack, Err(error)),
            Err(Refused::Store(error)) if error.as_trouble().is_some() => {
                (Outcome::Failed(error.told()), Err(error.into()))
            }
            Err(Refused::Store(error)) => (Outcome::RolledBack, Err(error.into())),
        };
        self.result = Some(result);
        outcome
    }

    fn settle(self: Box<Self>, committed: Result<(), StoreError>) {
        let result = match committed {
            Ok(()) => self.result.unwrap_or_else(|| Err(ended().into())),
            Err(error) => Err(error.into()),
        };
        // Whoever asked may have gone meanwhile.
        let _ = self.reply.send(result);
    }
}

fn work(messages: &Receiver<Message>, place: &Place, open: &dyn Fn() -> Result<Connection, StoreError>) {
    let mut kept = None;
    while let Ok(first) = messages.recv() {
        let (mut group, close) = gather(first, messages);
        // A database that is gone is not opened again: that would make another in its place.
        let opened = place.holds().and_then(|()| kept.take().map_or_else(open, Ok));
        let committed = opened.and_then(|connection| {
            commit(&connection, &mut group)?;
            kept = Some(connection);
            place.holds_what_was_written()
        });
        for job in group {
            job.settle(committed.as_ref().copied().map_err(StoreError::told));
        }
        if let Some(done) = close {
            drop(kept);
            let _ = done.send(());
            return;
        }
    }
}

/// All that has queued behind a message, up to the end that was asked for.
fn gather(first: Message, messages: &Receiver<Message>) -> (Vec<Box<dyn Job>>, Option<oneshot::Sender<()>>) {
    let (mut group, mut next) = (Vec::new(), Some(first));
    while let Some(message) = next {
        match message {
            Message::Job(job) => group.push(job),
            Message::Close(done) => return (group, Some(done)),
        }
        next = if group.len() < MOST_JOBS { messages.try_recv().ok() } else { None };
    }
    (group, None)
}

/// Runs a group in one transaction, each job in a savepoint of its own.
fn commit(connection: &Connection, group: &mut [Box<dyn Job>]) -> Result<(), StoreError> {
    let step = |sql| connection.prepare_cached(sql)?.execute([]).map(drop);
    step("BEGIN IMMEDIATE")?;
    for job in group {
        step("SAVEPOINT job")?;
        // A job that panics has nobody to answer but its own caller.
        match catch_unwind(AssertUnwindSafe(|| job.run(connection))) {
            Ok(Outcome::Done) => {}
            Ok(Outcome::RolledBack) | Err(_) => step("ROLLBACK TO job")?,
            Ok(Outcome::Failed(error)) => return Err(error),
        }
        step("RELEASE job")?;
    }
    Ok(step("COMMIT")?)
}
