//! Opening, starting and stopping.

use crate::app::{App, LoadedStudy, Served, Stimuli};
use crate::error::StartError;
use crate::library::Library;
use crate::links::Links;
use crate::making::{self, Maker, Making};
use crate::{password, routes};
use axum::Router;
use kelir_store::Store;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use tokio::net::TcpListener;
use tokio::sync::watch;
use tokio::task::JoinHandle;

/// What a server is started with.
pub struct ServerConfig {
    /// Folder of the database, the stimuli and own studies; made if need be.
    pub data: PathBuf,
    /// Address to listen on; port 0 takes a free one.
    pub listen: SocketAddr,
    /// The researcher's password in place of the generated one.
    pub password: Option<String>,
    /// Whether cookies are sent over HTTPS alone; for a server behind TLS.
    pub secure_cookies: bool,
    /// Who draws the stimuli.
    pub maker: Arc<dyn Maker>,
    /// Told how far the stimuli are; called from a worker thread.
    pub progress: Arc<dyn Fn(Making) + Send + Sync>,
}

/// A data folder with its studies, ready to answer requests.
#[derive(Clone)]
pub struct Server {
    app: Arc<App>,
}

impl Server {
    /// Opens the data folder, checks every study and sets the researcher's password up.
    ///
    /// # Errors
    /// The folder cannot be used, or a study is wrong.
    pub async fn open(config: &ServerConfig) -> Result<Server, StartError> {
        let library = Library::new(&config.data);
        let studies: Vec<_> =
            library.study_files().iter().map(|path| library.study(path)).collect::<Result<_, _>>()?;
        let store = Store::open(&config.data).await?;
        password::set_up(&store, config.password.as_deref()).await?;
        for study in &studies {
            store.put_study_file(study).await?;
        }
        let links = Links::open(&config.data).map_err(StartError::LinkKey)?;
        let app = App::new(store, library, config.maker.clone(), studies, config.secure_cookies, links);
        Ok(Server { app: Arc::new(app) })
    }

    /// Opens, listens, and makes what is missing of the stimuli while it already answers (503 for studies not ready).
    ///
    /// # Errors
    /// As [`Server::open`], and when the address cannot be listened on.
    pub async fn start(config: ServerConfig) -> Result<Handle, StartError> {
        let server = Server::open(&config).await?;
        let failed = |source| StartError::Listen { address: config.listen, source };
        let listener = TcpListener::bind(config.listen).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let (stop, stopped) = watch::channel(false);
        let (made, ready) = watch::channel(None);
        let maker = {
            let (server, progress) = (server.clone(), config.progress.clone());
            tokio::spawn(async move {
                let outcome = server.make_stimuli(progress.as_ref()).await;
                made.send_replace(Some(outcome));
            })
        };
        let serving = {
            let router = server.router().into_make_service_with_connect_info::<SocketAddr>();
            let mut stopped = stopped;
            tokio::spawn(async move {
                let stop = async move {
                    // An error means that the handle is gone, which also means to stop.
                    let _ = stopped.wait_for(|stop| *stop).await;
                };
                axum::serve(listener, router).with_graceful_shutdown(stop).await
            })
        };
        Ok(Handle { server, address, stop, ready, maker, serving })
    }

    /// All routes; for tests that need no network.
    pub fn router(&self) -> Router {
        routes::router(self.app.clone())
    }

    /// Makes what is missing of every study's stimuli, one after another.
    ///
    /// # Errors
    /// A line for each study whose stimuli could not be made; the others are ready all the same.
    pub async fn make_stimuli(&self, progress: &(dyn Fn(Making) + Send + Sync)) -> Result<(), String> {
        let mut wrong = Vec::new();
        for (id, loaded) in &self.app.studies {
            let report = |making: Making| {
                loaded.set_stimuli(Stimuli::Preparing(Some(making.clone())));
                progress(making);
            };
            let app = &self.app;
            match making::make(&loaded.study, &app.store, &app.library, &app.maker, &report).await {
                Ok(stimuli) => {
                    // The version is fixed when all that it shows is there.
                    let version = app.store.put_version(&loaded.study, &stimuli.all()).await;
                    match version {
                        Ok(version) => loaded.set_stimuli(Stimuli::Ready(Arc::new(Served {
                            version,
                            stimuli: Arc::new(stimuli),
                        }))),
                        Err(error) => failed(id, loaded, error.to_string(), &mut wrong),
                    }
                }
                Err(error) => {
                    failed(id, loaded, error.to_string(), &mut wrong);
                }
            }
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
    }

    /// Ids of the studies that are served, sorted.
    pub fn studies(&self) -> Vec<String> {
        self.app.studies.keys().cloned().collect()
    }

    /// The store behind it.
    pub fn store(&self) -> &Store {
        &self.app.store
    }

    /// The file with the generated researcher password, if there is one.
    pub fn password_file(&self) -> Option<PathBuf> {
        Some(password::file(self.app.store.folder())).filter(|path| path.exists())
    }
}

/// Notes that a study cannot be taken, and why.
fn failed(id: &str, loaded: &LoadedStudy, reason: String, wrong: &mut Vec<String>) {
    tracing::error!("study {id}: {reason}");
    wrong.push(format!("study {id}: {reason}"));
    loaded.set_stimuli(Stimuli::Failed(reason));
}

/// A running server; dropping it stops it.
pub struct Handle {
    server: Server,
    address: SocketAddr,
    stop: watch::Sender<bool>,
    ready: watch::Receiver<Option<Result<(), String>>>,
    maker: JoinHandle<()>,
    serving: JoinHandle<std::io::Result<()>>,
}

impl Handle {
    /// The address it listens on, with the port it got.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The server itself.
    pub fn server(&self) -> &Server {
        &self.server
    }

    /// Waits until every study's stimuli are made.
    ///
    /// # Errors
    /// A line for each study whose stimuli could not be made.
    pub async fn ready(&self) -> Result<(), String> {
        let mut ready = self.ready.clone();
        match ready.wait_for(Option::is_some).await {
            Ok(outcome) => outcome.clone().unwrap_or(Ok(())),
            Err(_) => Err("making the stimuli was interrupted".to_owned()),
        }
    }

    /// Finishes the requests under way, for at most ten seconds, and closes the database.
    pub async fn shutdown(self) {
        self.maker.abort();
        self.stop.send_replace(true);
        let limit = std::time::Duration::from_secs(10);
        match tokio::time::timeout(limit, self.serving).await {
            Ok(Ok(Ok(()))) => {}
            Ok(Ok(Err(error))) => tracing::error!("serving: {error}"),
            Ok(Err(error)) => tracing::error!("serving: {error}"),
            Err(_) => tracing::warn!("requests still under way after ten seconds were cut off"),
        }
        self.server.app.store.close().await;
    }
}
