//! `kelir serve`: the platform on one address.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use anyhow::Result;
use kelir_house::RenderMaker;
use kelir_house::making::Making;
use kelir_server::{Handle, PasswordSource, Server, ServerConfig, TrustedProxies};
use kelir_store::FolderLock;

use crate::log::Log;
use crate::output::print;
use crate::{bad_input, progress};

/// Arguments of `kelir serve`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of the database, the stimuli, own studies and the researcher's password; made if it does not exist.
    #[arg(long)]
    data: PathBuf,
    /// Address and port to listen on; port 0 takes a free one.
    #[arg(long, default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Send the researcher's cookie over HTTPS alone: for a server behind TLS.
    #[arg(long)]
    secure_cookies: bool,
    /// Address or network of a proxy before this server, such as 10.0.0.0/8: its X-Forwarded-For says who asks. Several with commas; also from
    /// KELIR_TRUSTED_PROXIES.
    #[arg(long, value_name = "CIDR", value_delimiter = ',')]
    trusted_proxy: Vec<String>,
}

/// Runs the command until it is interrupted.
pub(crate) fn run(args: Args) -> Result<()> {
    let log = Log::begin(&args.data);
    let runtime = tokio::runtime::Runtime::new()?;
    let served = runtime.block_on(serve(args, log.file.as_deref()));
    // A picture that is being drawn is drawn again at the next start; nobody waits for it.
    runtime.shutdown_timeout(Duration::from_secs(1));
    log.flush(Duration::from_secs(1));
    served
}

async fn serve(args: Args, log: Option<&Path>) -> Result<()> {
    // Held until this returns.
    let _lock = FolderLock::take(&args.data, &format!("http://{}", args.listen))?;
    let trusted_proxies = trusted_proxies(&args.trusted_proxy).map_err(bad_input)?;
    let bar = progress::bar(0, "stimuli");
    let config = ServerConfig {
        data: args.data,
        listen: args.listen,
        password: std::env::var("KELIR_RESEARCHER_PASSWORD").ok().filter(|password| !password.is_empty()),
        secure_cookies: args.secure_cookies,
        trusted_proxies,
        maker: Arc::new(RenderMaker::default()),
        progress: {
            let bar = bar.clone();
            Arc::new(move |making| show(&bar, &making))
        },
    };
    let handle = Server::start(config).await?;
    for line in greeting(&handle) {
        say(&line);
    }
    if let Some(file) = log {
        say(&format!("log            {}", file.display()));
    }
    let mut asked_to_stop = std::pin::pin!(stop_signal());
    tokio::select! {
        made = handle.ready() => {
            bar.finish_and_clear();
            match made {
                Ok(()) => say("The stimuli are ready."),
                // The other studies are served all the same; the console and the log say what is wrong with these.
                Err(problems) => say(&format!("Not every study can be taken:\n{problems}")),
            }
            asked_to_stop.await;
        }
        () = &mut asked_to_stop => bar.finish_and_clear(),
    }
    handle.shutdown().await;
    Ok(())
}

/// The proxies named by the option, else by the environment.
fn trusted_proxies(named: &[String]) -> Result<TrustedProxies, String> {
    let environment = std::env::var("KELIR_TRUSTED_PROXIES").unwrap_or_default();
    let named = named.iter().map(String::as_str);
    match named.len() {
        0 => TrustedProxies::parse(environment.split(',').filter(|network| !network.trim().is_empty())),
        _ => TrustedProxies::parse(named),
    }
}

/// A line for whoever started the server, if anybody can read it: a closed terminal stops no study.
fn say(line: &str) {
    let _ = print(line);
}

/// Where to go and how to sign in.
fn greeting(handle: &Handle) -> Vec<String> {
    let (bases, server) = (bases(handle.address()), handle.server());
    let mut lines = Vec::new();
    for base in &bases {
        lines.extend(server.studies().iter().map(|study| format!("participants   {base}/study/{study}")));
        lines.push(format!("researchers    {base}/console"));
    }
    if handle.address().ip().is_unspecified() {
        lines.push(
            "The first links are for this machine; others reach it by its name or address, at the same port."
                .to_owned(),
        );
    }
    lines.push(match server.password_source() {
        PasswordSource::File(file) => format!("sign in with the password in {}", file.display()),
        PasswordSource::Given => {
            "sign in with the password of KELIR_RESEARCHER_PASSWORD; the one in the data folder, if any, is not in force".to_owned()
        }
        PasswordSource::Stored => {
            "sign in with the password of before: its file was taken away, the database has its hash".to_owned()
        }
    });
    lines
}

/// Links that can be opened: an address that means "any" is no place to go to, so this machine's own stand for it.
fn bases(listening: SocketAddr) -> Vec<String> {
    if !listening.ip().is_unspecified() {
        return vec![format!("http://{listening}")];
    }
    let port = listening.port();
    let outward = outward_address(listening).map(|ip| format!("http://{}", SocketAddr::new(ip, port)));
    std::iter::once(format!("http://127.0.0.1:{port}")).chain(outward).collect()
}

/// The address by which this machine reaches others, which is most often the one by which they reach it. Nothing is sent.
fn outward_address(listening: SocketAddr) -> Option<std::net::IpAddr> {
    let documentation = if listening.is_ipv6() { "[2001:db8::1]:9" } else { "192.0.2.1:9" };
    let socket = std::net::UdpSocket::bind(SocketAddr::new(listening.ip(), 0)).ok()?;
    socket.connect(documentation).ok()?;
    let address = socket.local_addr().ok()?.ip();
    (!address.is_loopback() && !address.is_unspecified()).then_some(address)
}

fn show(bar: &indicatif::ProgressBar, making: &Making) {
    bar.set_length(making.total as u64 * 100);
    bar.set_position(making.done as u64 * 100 + (making.fraction * 100.0) as u64);
    bar.set_message(making.stimulus.clone());
}

/// Returns when the process is asked to end: Ctrl-C, or SIGTERM from a service manager.
async fn stop_signal() {
    let interrupt = tokio::signal::ctrl_c();
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        match signal(SignalKind::terminate()) {
            Ok(mut terminate) => {
                tokio::select! {
                    _ = interrupt => {}
                    _ = terminate.recv() => {}
                }
            }
            Err(_) => drop(interrupt.await),
        }
    }
    #[cfg(not(unix))]
    drop(interrupt.await);
}
