//! Bodies that tell their connection's guard how far a request is.

use super::line::{Line, Phase};
use crate::audit::Access;
use axum::body::{Body, Bytes};
use hyper::body::{Body as HttpBody, Frame, Incoming, SizeHint};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

/// A request's body: once it is here, the server is at work.
pub(super) struct Received {
    body: Incoming,
    line: Arc<Line>,
}

impl Received {
    pub(super) fn new(body: Incoming, line: Arc<Line>) -> Received {
        line.enter(if body.is_end_stream() { Phase::Working } else { Phase::Receiving });
        Received { body, line }
    }
}

impl HttpBody for Received {
    type Data = Bytes;
    type Error = hyper::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, hyper::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(cx);
        let ended = matches!(frame, Poll::Ready(None)) || frame.is_ready() && self.body.is_end_stream();
        if ended && self.line.phase() == Phase::Receiving {
            self.line.enter(Phase::Working);
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// An answer's body: once it has been handed over, the connection waits again and the access is logged.
pub(super) struct Sent {
    body: Body,
    line: Arc<Line>,
    access: Access,
}

impl Sent {
    pub(super) fn new(body: Body, line: Arc<Line>, access: Access) -> Sent {
        line.enter(Phase::Sending);
        Sent { body, line, access }
    }
}

impl HttpBody for Sent {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        let frame = Pin::new(&mut self.body).poll_frame(cx);
        if let Poll::Ready(Some(Ok(frame))) = &frame {
            self.access.bytes += frame.data_ref().map_or(0, Bytes::len);
        }
        frame
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

impl Drop for Sent {
    fn drop(&mut self) {
        self.line.enter(Phase::Waiting);
        self.access.log();
    }
}
