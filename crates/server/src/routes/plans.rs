//! What a session is shown: the trials of its plan with their stimuli, and what follows from its answers.

use crate::api::{self, Problem, Trial};
use crate::app::App;
use crate::loaded::Begun;
use crate::presenting::Whose;
use kelir_house::making::StimulusMap;
use kelir_store::{NextTrials, PlannedSession, PlannedTrial, Progress, SizedStimuli, StimulusHashes};
use kelir_study::{Decision, StudyDefinition, TrialPlan, next_trials};
use serde::Deserialize;
use std::collections::BTreeMap;
use utoipa::IntoParams;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct TrialPath {
    /// The session's id.
    pub(super) session: String,
    /// The trial's index, in plain digits.
    #[param(value_type = u32)]
    pub(super) trial_index: String,
}

/// The plan of a slot with its stimuli filled in.
pub(super) fn plan_of(
    study: &StudyDefinition,
    stimuli: &StimulusMap,
    slot: u32,
) -> Result<PlannedSession, Box<Problem>> {
    let TrialPlan { seed, trials, more, .. } = TrialPlan::for_slot(study, slot);
    Ok(PlannedSession { seed, next: NextTrials { trials: planned(stimuli, trials)?, more } })
}

/// Trials with their stimuli filled in.
pub(super) fn planned(
    stimuli: &StimulusMap,
    trials: Vec<kelir_study::Trial>,
) -> Result<Vec<PlannedTrial>, Box<Problem>> {
    let fill = |trial: kelir_study::Trial| {
        let mut sizes: Vec<SizedStimuli> = Vec::new();
        for (role, placed) in &trial.shown {
            if sizes.is_empty() {
                let of = stimuli.of(&placed.item, &placed.condition).map_err(Problem::internal)?;
                sizes =
                    of.iter().map(|one| SizedStimuli { size: one.size, stimuli: BTreeMap::new() }).collect();
            }
            for (rank, of_size) in sizes.iter_mut().enumerate() {
                let found = stimuli.at(&placed.item, &placed.condition, rank).map_err(Problem::internal)?;
                let (sha256, pixels_sha256) = (found.sha256.clone(), found.pixels_sha256.clone());
                of_size.stimuli.insert(*role, StimulusHashes { sha256, pixels_sha256 });
            }
        }
        let larger = sizes.split_off(sizes.len().min(1));
        let smallest = sizes.pop().map(|smallest| smallest.stimuli).unwrap_or_default();
        Ok(PlannedTrial { trial, stimuli: smallest, larger })
    };
    trials.into_iter().map(fill).collect()
}

/// What follows in a session from what it was shown and answered.
pub(super) fn next_of(begun: &Begun, slot: u32, progress: &Progress) -> Result<NextTrials, Box<Problem>> {
    let study = &begun.study;
    let chose_target = |index: u32| {
        let trial = &progress.trials.get(index as usize)?.trial;
        let chosen = trial.trial.rules().chosen(progress.answers.get(&index)?)?;
        Some(trial.shown.get(&chosen)?.condition == study.block(&trial.block_id)?.target)
    };
    let decided: Vec<kelir_study::Trial> =
        progress.trials.iter().map(|planned| planned.trial.clone()).collect();
    let Decision { trials, more } = next_trials(study, slot, &decided, &chose_target);
    Ok(NextTrials { trials: planned(&begun.stimuli, trials)?, more })
}

/// Trials as a page is told them.
pub(super) async fn trials_of(
    app: &App,
    whose: Whose<'_>,
    study: &StudyDefinition,
    planned: &[PlannedTrial],
    answered: &[u32],
) -> Result<Vec<Trial>, Box<Problem>> {
    let [width, height] = study.size;
    let mut trials = Vec::with_capacity(planned.len());
    for planned in planned {
        let trial = &planned.trial;
        let mut told = app.presenter.tell(&app.store, whose, planned).await?.into_iter();
        let shown = told.next().unwrap_or_default();
        let larger =
            planned.larger.iter().zip(told).map(|(SizedStimuli { size: [width, height], .. }, shown)| {
                api::SizedStimuli { width: *width, height: *height, shown }
            });
        trials.push(Trial {
            trial_index: trial.trial_index,
            trial: trial.trial.rules().name(),
            block_index: trial.block_index,
            item_index: trial.item_index,
            kind: trial.kind,
            shown,
            larger: larger.collect(),
            settings: trial.trial.settings(),
            width,
            height,
            answered: answered.contains(&trial.trial_index),
        });
    }
    Ok(trials)
}
