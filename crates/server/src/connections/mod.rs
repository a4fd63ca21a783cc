//! Connections: accepted, guarded and ended.
//!
//! Nobody can hold the server by saying nothing: silent connections end, and where there are too many the oldest silent one makes room.

mod bodies;
mod descriptors;
mod line;
mod registry;

pub(crate) use registry::Registry;

use crate::address::network;
use crate::audit::Access;
use crate::headers::Answered;
use crate::proxies::TrustedProxies;
use crate::rarely::Rarely;
use axum::Router;
use axum::extract::ConnectInfo;
use bodies::{Received, Sent};
use hyper::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use line::{Line, Patience, Phase, Watched};
use registry::{Caps, Crowded};
use std::convert::Infallible;
use std::io;
use std::net::SocketAddr;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::{Duration, Instant};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::watch;
use tokio::task::JoinSet;

/// Connections of one address that nobody is known to take part from.
const OF_ONE_ADDRESS: usize = 256;
/// Connections in all, where there are descriptors for so many.
const IN_ALL: usize = 16_384;
/// Descriptors that the database, stimuli and logs need.
const KEPT_BACK: usize = 64;
/// The largest head of a request.
const HEAD_BYTES: usize = 64 << 10;

/// The routes that are served now: they change once, when the data folder is open.
pub(crate) type Routes = Arc<RwLock<Router>>;

/// What all connections share.
#[derive(Clone)]
pub(crate) struct Guard {
    pub(crate) registry: Arc<Registry>,
    patience: Patience,
    proxies: TrustedProxies,
}

impl Guard {
    /// Raises the process's limit of open files and shares it out.
    pub(crate) fn new(proxies: TrustedProxies) -> Guard {
        let descriptors = descriptors::raise();
        let all = descriptors.saturating_sub(KEPT_BACK).clamp(16, IN_ALL);
        tracing::debug!("room for {all} connections of {descriptors} descriptors");
        let registry = Registry::new(Caps { all, one_address: OF_ONE_ADDRESS.min(all) });
        Guard { registry: Arc::new(registry), patience: Patience::default(), proxies }
    }
}

/// Accepts connections until `stop`, then lets what is being answered finish; whoever awaits this sets the limit, and dropping it cuts off.
pub(crate) async fn serve(
    listener: TcpListener,
    routes: Routes,
    guard: Guard,
    mut stop: watch::Receiver<bool>,
) {
    let mut connections = JoinSet::new();
    let (refusals, failures) = (Rarely::default(), Rarely::default());
    loop {
        let accepted = tokio::select! {
            accepted = listener.accept() => accepted,
            Some(_) = connections.join_next() => continue,
            // An error means that the handle is gone, which also means to stop.
            _ = stop.wait_for(|stop| *stop) => break,
        };
        let (stream, peer) = match accepted {
            Ok(accepted) => accepted,
            Err(error) => {
                not_accepted(&error, &guard, &failures).await;
                continue;
            }
        };
        let (line, crowded) = guard.registry.admit(network(peer.ip()), guard.proxies.contains(peer.ip()));
        if let Some(crowded) = crowded {
            let of = match crowded {
                Crowded::Address => "of one address",
                Crowded::All => "in all",
            };
            let what =
                if line.is_some() { "the oldest silent one was closed" } else { "a new one was refused" };
            refusals.say(|before| tracing::warn!("too many connections {of}: {what}{before}"));
        }
        if let Some(line) = line {
            let (routes, guard, stop) = (routes.clone(), guard.clone(), stop.clone());
            connections.spawn(async move {
                attend(stream, peer, &line, routes, &guard, stop).await;
                guard.registry.leave(&line);
            });
        }
    }
    drop(listener);
    while connections.join_next().await.is_some() {}
}

/// The listener goes on, whatever happened; where descriptors have run out, a silent connection gives its own.
async fn not_accepted(error: &io::Error, guard: &Guard, failures: &Rarely) {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    if matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset) {
        return;
    }
    failures.say(|before| tracing::error!("a connection could not be accepted: {error}{before}"));
    guard.registry.make_room();
    tokio::time::sleep(Duration::from_millis(50)).await;
}

/// One connection from its first byte to its end.
async fn attend(
    stream: TcpStream,
    peer: SocketAddr,
    line: &Arc<Line>,
    routes: Routes,
    guard: &Guard,
    mut stop: watch::Receiver<bool>,
) {
    // Small answers must not wait for larger packets.
    let _ = stream.set_nodelay(true);
    let of_request = line.clone();
    let service = service_fn(move |mut request: Request<Incoming>| {
        let line = of_request.clone();
        request.extensions_mut().insert(ConnectInfo(peer));
        let request = request.map(|body| Received::new(body, line.clone()));
        let router = routes.read().unwrap_or_else(PoisonError::into_inner).clone();
        let (method, begun) = (request.method().clone(), Instant::now());
        let answer = TowerToHyperService::new(router).call(request);
        let registry = guard.registry.clone();
        async move {
            let answer = answer.await?;
            let answered = answer.extensions().get::<Answered>().cloned().unwrap_or_default();
            if answered.consented {
                registry.know(peer.ip());
            }
            let access = Access { method, route: answered.route, status: answer.status(), begun, bytes: 0 };
            Ok::<_, Infallible>(answer.map(|body| Sent::new(body, line, access)))
        }
    });
    let io = TokioIo::new(Watched { stream, line: line.clone() });
    let mut builder = http1::Builder::new();
    builder.timer(TokioTimer::new()).header_read_timeout(guard.patience.waiting).max_header_size(HEAD_BYTES);
    let mut connection = std::pin::pin!(builder.serve_connection(io, service));
    let mut stopping = false;
    loop {
        // What the connection is at changes meanwhile, and its deadline with it.
        let look = tokio::time::sleep(guard.patience.receiving / 3);
        tokio::select! {
            ended = connection.as_mut() => {
                if let Err(error) = ended {
                    tracing::trace!("a connection ended: {error}");
                }
                return;
            }
            () = line.told_to_close() => return,
            () = look => {
                if line.deadline(&guard.patience).is_some_and(|deadline| deadline <= Instant::now()) {
                    return;
                }
            }
            _ = stop.wait_for(|stop| *stop), if !stopping => {
                if line.phase() == Phase::Waiting {
                    return;
                }
                stopping = true;
                connection.as_mut().graceful_shutdown();
            }
        }
    }
}

#[cfg(test)]
mod tests;
