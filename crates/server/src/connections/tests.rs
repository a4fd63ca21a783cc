//! Real sockets against the guard, with a short patience.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use axum::routing::{get, post};
use std::net::Ipv4Addr;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::task::JoinHandle;

struct Served {
    address: SocketAddr,
    stop: watch::Sender<bool>,
    serving: JoinHandle<()>,
}

async fn serving(caps: Caps, patience: Patience) -> Served {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).await.unwrap();
    let address = listener.local_addr().unwrap();
    let router =
        Router::new().route("/", get(async || "here")).route("/echo", post(async |body: String| body));
    let registry = Arc::new(Registry::new(caps));
    let guard = Guard { registry, patience, proxies: TrustedProxies::default() };
    let (stop, stopped) = watch::channel(false);
    let serving = tokio::spawn(serve(listener, Arc::new(RwLock::new(router)), guard, stopped));
    Served { address, stop, serving }
}

fn caps(all: usize, one_address: usize) -> Caps {
    Caps { all, one_address }
}

fn short() -> Patience {
    let ms = Duration::from_millis;
    Patience { waiting: ms(400), receiving: ms(400), body: ms(60_000), sending: ms(400) }
}

impl Served {
    async fn connect(&self) -> TcpStream {
        TcpStream::connect(self.address).await.unwrap()
    }

    /// All that comes back until the server closes.
    async fn ask(&self, request: &str) -> String {
        let mut stream = self.connect().await;
        stream.write_all(request.as_bytes()).await.unwrap();
        rest(&mut stream).await
    }

    async fn answers(&self) {
        let answer = self.ask("GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").await;
        assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("here"), "{answer}");
    }
}

async fn rest(stream: &mut TcpStream) -> String {
    let mut text = Vec::new();
    // A reset ends a connection too.
    let _ = stream.read_to_end(&mut text).await;
    String::from_utf8(text).unwrap()
}

#[tokio::test]
async fn idle_connections_of_one_address_keep_nobody_out() {
    let served = serving(caps(1000, 20), Patience::default()).await;
    let mut idle = Vec::new();
    for _ in 0..100 {
        idle.push(served.connect().await);
        if idle.len() % 10 == 0 {
            served.answers().await;
        }
    }
    // The oldest made room: their ends are closed.
    assert_eq!(rest(&mut idle[0]).await, "");
    idle.last_mut().unwrap().write_all(b"GET / HTTP/1.0\r\n\r\n").await.unwrap();
    assert!(rest(idle.last_mut().unwrap()).await.ends_with("here"), "the newest are open");
}

#[tokio::test]
async fn half_sent_heads_and_bodies_end_and_others_are_answered() {
    let served = serving(caps(1000, 1000), short()).await;
    assert_eq!(served.ask("").await, "", "said nothing");
    assert_eq!(served.ask("GET / HTTP/1.1\r\nHo").await, "", "half a head");
    let body = "POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\nhalf";
    assert_eq!(served.ask(body).await, "", "half a body");
    served.answers().await;
}

#[tokio::test]
async fn a_slow_line_that_is_alive_is_left_alone() {
    let served = serving(caps(1000, 1000), short()).await;
    let mut stream = served.connect().await;
    stream
        .write_all(b"POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 30\r\nConnection: close\r\n\r\n")
        .await
        .unwrap();
    for _ in 0..30 {
        // In all far longer than the patience between two bytes.
        tokio::time::sleep(Duration::from_millis(50)).await;
        stream.write_all(b"x").await.unwrap();
    }
    assert!(rest(&mut stream).await.ends_with(&"x".repeat(30)));
}

#[tokio::test]
async fn a_body_has_an_end() {
    let patience = Patience { body: Duration::from_millis(500), ..short() };
    let served = serving(caps(1000, 1000), patience).await;
    let mut stream = served.connect().await;
    stream.write_all(b"POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 100000\r\n\r\n").await.unwrap();
    let (mut read, mut write) = stream.into_split();
    let dripping = tokio::spawn(async move {
        while write.write_all(b"x").await.is_ok() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    });
    assert_eq!(read.read(&mut [0]).await.unwrap_or(0), 0);
    dripping.abort();
}

#[tokio::test]
async fn stopping_ends_idle_connections_and_lets_answers_finish() {
    let served = serving(caps(1000, 1000), Patience::default()).await;
    let mut idle = served.connect().await;
    let mut half = served.connect().await;
    half.write_all(b"GET / HT").await.unwrap();
    let mut kept = served.connect().await;
    kept.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").await.unwrap();
    kept.read_exact(&mut [0; 12]).await.unwrap();
    let mut sending = served.connect().await;
    sending.write_all(b"POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\n\r\nha").await.unwrap();
    served.answers().await;
    served.stop.send_replace(true);
    assert_eq!((rest(&mut idle).await, rest(&mut half).await), (String::new(), String::new()));
    assert!(rest(&mut kept).await.ends_with("here"));
    assert!(!served.serving.is_finished(), "an answer is on its way");
    sending.write_all(b"lf").await.unwrap();
    assert!(rest(&mut sending).await.ends_with("half"));
    served.serving.await.unwrap();
    assert!(TcpStream::connect(served.address).await.is_err(), "nobody listens any more");
}
