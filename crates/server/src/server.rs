//! Opening, starting and stopping.

use crate::app::App;
use crate::audit::AUDIT;
use crate::config::ServerConfig;
use crate::connections::{self, Guard, Routes};
use crate::error::StartError;
use crate::loaded::{BrokenStudy, LoadedStudy, Served, Stimuli};
use crate::password::{self, PasswordSource};
use crate::{integrity, routes, starting};
use axum::Router;
use kelir_house::Library;
use kelir_house::links::Links;
use kelir_house::making::{Making, make};
use kelir_store::Store;
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::atomic::Ordering;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::watch;
use tokio::task::JoinHandle;

/// How long requests under way may take once the server is asked to stop, and the database after them.
const GRACE: Duration = Duration::from_secs(10);
const CLOSING: Duration = Duration::from_secs(3);

/// A data folder with its studies, ready to answer requests.
#[derive(Clone)]
pub struct Server {
    app: Arc<App>,
    password: PasswordSource,
}

impl Server {
    /// Opens the data folder, checks every study and sets the researcher's password up. A study that is wrong is not served, and the others are.
    ///
    /// # Errors
    /// The folder cannot be used.
    pub async fn open(config: &ServerConfig) -> Result<Server, StartError> {
        let store = Store::open(&config.data).await?;
        let password = password::set_up(&store, config.password.as_deref()).await?;
        let library = Library::remembering(&config.data);
        let (mut studies, mut broken) = (Vec::new(), BTreeMap::new());
        for path in library.study_files() {
            match library.study(&path) {
                Ok(study) => studies.push(study),
                Err(error) => {
                    let wrong = BrokenStudy::new(&library, &path, &error);
                    tracing::error!(target: AUDIT, study = wrong.id, "is not served: {}", wrong.reason);
                    broken.insert(wrong.id.clone(), wrong);
                }
            }
        }
        for study in &studies {
            store.put_study_file(study).await?;
        }
        let links = Links::open(&config.data).map_err(StartError::LinkKey)?;
        let app = App::new(store, library, studies, broken, config, links);
        for (id, loaded) in &app.studies {
            for warning in &loaded.warnings {
                tracing::warn!(target: AUDIT, study = id, "is served, and may have a mistake: {warning}");
            }
        }
        Ok(Server { app: Arc::new(app), password })
    }

    /// Listens, opens, and makes what is missing of the stimuli while it already answers (503 for what is not ready).
    ///
    /// # Errors
    /// As [`Server::open`], and when the address cannot be listened on.
    pub async fn start(config: ServerConfig) -> Result<Handle, StartError> {
        let failed = |source| StartError::Listen { address: config.listen, source };
        let listener = TcpListener::bind(config.listen).await.map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let (stop, stopped) = watch::channel(false);
        let routes: Routes = Arc::new(RwLock::new(starting::router()));
        let guard = Guard::new(config.trusted_proxies.clone());
        let serving = tokio::spawn(connections::serve(listener, routes.clone(), guard, stopped));
        // Where this fails, `stop` is dropped, which ends the listener.
        let server = Server::open(&config).await?;
        *routes.write().unwrap_or_else(PoisonError::into_inner) = server.router();
        tracing::info!(target: AUDIT, %address, studies = server.app.studies.len(), "started");
        let (made, ready) = watch::channel(None);
        let maker = {
            let (server, progress, mut ended) = (server.clone(), config.progress.clone(), stop.subscribe());
            tokio::spawn(async move {
                let outcome = server.make_stimuli(progress.as_ref()).await;
                made.send_replace(Some(outcome));
                tokio::select! {
                    () = integrity::watch(server.app) => {}
                    // To stop, or because the handle is gone.
                    _ = ended.changed() => {}
                }
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
    /// A line for each study that cannot be taken, because its file is wrong or its stimuli could not be made; the others are ready all the same.
    pub async fn make_stimuli(&self, progress: &(dyn Fn(Making) + Send + Sync)) -> Result<(), String> {
        let mut wrong = Vec::new();
        for (id, loaded) in &self.app.studies {
            let report = |making: Making| {
                loaded.set_stimuli(Stimuli::Preparing(Some(making.clone())));
                progress(making);
            };
            let app = &self.app;
            match make(&loaded.study, &app.store, &app.library, &app.maker, &report).await {
                Ok(stimuli) => {
                    // The version is fixed when all that it shows is there.
                    let version = app.store.put_version(&loaded.study, &stimuli.all()).await;
                    match version {
                        Ok(version) => loaded.set_stimuli(Stimuli::Ready(Arc::new(Served {
                            version,
                            stimuli: Arc::new(stimuli),
                        }))),
                        Err(_) if app.stopping.load(Ordering::Relaxed) => return Err(interrupted()),
                        Err(error) => failed(id, loaded, error.to_string(), &mut wrong),
                    }
                }
                Err(_) if app.stopping.load(Ordering::Relaxed) => {
                    return Err(interrupted());
                }
                Err(error) => failed(id, loaded, error.to_string(), &mut wrong),
            }
        }
        wrong
            .extend(self.app.broken.values().map(|broken| format!("study {}: {}", broken.id, broken.reason)));
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
    }

    /// Looks once whether all that is stored is whole, and mends what can be mended; answers what is wrong. A running server does so every hour.
    pub async fn check_integrity(&self) -> Vec<String> {
        integrity::look(&self.app).await;
        self.app.integrity.faults()
    }

    /// Ids of the studies that are served, sorted.
    pub fn studies(&self) -> Vec<String> {
        self.app.studies.keys().cloned().collect()
    }

    /// The store behind it.
    pub fn store(&self) -> &Store {
        &self.app.store
    }

    /// Where the researcher's password that is in force comes from.
    pub fn password_source(&self) -> &PasswordSource {
        &self.password
    }
}

fn interrupted() -> String {
    "making the stimuli was interrupted".to_owned()
}

/// Notes that a study cannot be taken, and why.
fn failed(id: &str, loaded: &LoadedStudy, reason: String, wrong: &mut Vec<String>) {
    tracing::error!(target: AUDIT, study = id, "cannot be taken: {reason}");
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
    serving: JoinHandle<()>,
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
            Err(_) => Err(interrupted()),
        }
    }

    /// Finishes the requests under way, for at most ten seconds, and closes the database.
    pub async fn shutdown(mut self) {
        self.server.app.stopping.store(true, Ordering::Relaxed);
        self.maker.abort();
        self.stop.send_replace(true);
        if tokio::time::timeout(GRACE, &mut self.serving).await.is_err() {
            tracing::warn!("requests still under way after {} seconds were cut off", GRACE.as_secs());
            self.serving.abort();
        }
        // What was cut off may still hold a connection of the database.
        if tokio::time::timeout(CLOSING, self.server.app.store.close()).await.is_err() {
            tracing::warn!("the database was still in use; what was acknowledged is on disk");
        }
        tracing::info!(target: AUDIT, "stopped");
    }
}
