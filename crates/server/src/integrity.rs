//! Whether what is stored is still what was stored: looked at after the start and every hour, mended where that can be done.
//!
//! Answers are taken whatever is found here. A study whose stimuli are damaged for good pauses: nobody begins it until they are back.

use crate::app::App;
use crate::audit::AUDIT;
use crate::loaded::{LoadedStudy, Served, Stimuli};
use kelir_house::making::{is_whole, make};
use kelir_store::Trouble;
use std::sync::Arc;
use std::time::Duration;

/// Between two looks.
const EVERY: Duration = Duration::from_secs(3600);
/// At least so long between two looks, however often somebody asks for one.
const REST: Duration = Duration::from_secs(30);

/// Looks again and again, for as long as the server runs.
pub(crate) async fn watch(app: Arc<App>) {
    loop {
        look(&app).await;
        tokio::time::sleep(REST).await;
        tokio::select! {
            () = tokio::time::sleep(EVERY) => {}
            () = app.integrity.asked() => {}
        }
    }
}

/// Looks at everything once, and mends what can be mended.
pub(crate) async fn look(app: &App) {
    let mut faults = of_database(app).await;
    for loaded in app.studies.values() {
        faults.extend(of_chain(app, &loaded.study.id).await);
        faults.extend(of_stimuli(app, loaded).await);
    }
    let before = app.integrity.note(faults.clone());
    for fault in faults.iter().filter(|fault| !before.contains(fault)) {
        tracing::error!(target: AUDIT, "integrity: {fault}");
    }
    if faults.is_empty() && !before.is_empty() {
        tracing::info!(target: AUDIT, "integrity: all is well again");
    }
}

async fn of_database(app: &App) -> Vec<String> {
    match app.store.quick_check().await {
        Ok(faults) => faults.into_iter().map(|fault| format!("The database is damaged: {fault}")).collect(),
        Err(error) if error.as_trouble() == Some(Trouble::Damaged) => {
            vec![format!("The database is damaged: {error}")]
        }
        Err(error) => vec![format!("The database cannot be checked: {error}")],
    }
}

async fn of_chain(app: &App, study: &str) -> Option<String> {
    match app.store.verify_chain(study).await {
        Ok(report) => {
            let unexplained = report.unexplained().count();
            let rows = if unexplained == 1 { "1 row".to_owned() } else { format!("{unexplained} rows") };
            (unexplained > 0).then(|| {
                format!("Study {study}: {rows} of its answers differ from what was written; kelir chain check {study} names them")
            })
        }
        Err(error) => Some(format!("Study {study}: its answers cannot be checked: {error}")),
    }
}

/// What is wrong with a study's stimuli after mending. A study pauses where something is, and goes on once it is not.
async fn of_stimuli(app: &App, loaded: &LoadedStudy) -> Option<String> {
    let id = &loaded.study.id;
    let known = app.integrity.paused().get(id).cloned();
    let (served, was_paused) = match (loaded.stimuli(), known) {
        (Stimuli::Ready(served), _) => (served, false),
        (Stimuli::Failed(_), Some(served)) => (served, true),
        // Being made, or never made: that has its own reason.
        _ => return None,
    };
    match mended(app, loaded, &served).await {
        Ok(count) => {
            if count > 0 {
                tracing::warn!(target: AUDIT, study = id, "integrity: {count} damaged stimuli were made again");
            }
            if was_paused {
                app.integrity.paused().remove(id);
                loaded.set_stimuli(Stimuli::Ready(served));
            }
            None
        }
        Err(reason) => {
            let reason = format!("it is paused, because stimuli are damaged: {reason}");
            loaded.set_stimuli(Stimuli::Failed(reason.clone()));
            app.integrity.paused().insert(id.clone(), served);
            Some(format!("Study {id}: {reason}"))
        }
    }
}

/// How many of a study's stimuli had to be made again, to the same bytes.
async fn mended(app: &App, loaded: &LoadedStudy, served: &Served) -> Result<usize, String> {
    let mut damaged = Vec::new();
    for stimulus in served.stimuli.all() {
        if !is_whole(&app.store, &stimulus.sha256).await.map_err(|error| error.to_string())? {
            damaged.push(stimulus);
        }
    }
    if damaged.is_empty() {
        return Ok(0);
    }
    let made = make(&loaded.study, &app.store, &app.library, &app.maker, &|_| {}).await;
    let made = made.map_err(|error| error.to_string())?;
    for stimulus in &damaged {
        let again = made.of(&stimulus.item, &stimulus.condition).map_err(|error| error.to_string())?;
        if !again.iter().any(|again| again.sha256 == stimulus.sha256) {
            return Err(format!(
                "{} ({}) was made again and came out otherwise",
                stimulus.item, stimulus.condition
            ));
        }
    }
    Ok(damaged.len())
}
