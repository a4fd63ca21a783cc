//! The knobs on the command line: `--knob NAME=VALUE`, and an option for each, made of the techniques' own tables.

use std::collections::BTreeMap;

use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Command, Error, FromArgMatches};
use kelir_render::Technique;
use kelir_render::techniques::knobs::Knob;
use serde_json::Value;

/// The knobs that are turned, by name. Whether the technique has them, and their ranges, [`Technique::parse`] knows.
pub(super) struct Turned(pub BTreeMap<String, Value>);

/// Every knob with the names of the techniques that have it.
fn every() -> Vec<(&'static Knob, Vec<&'static str>)> {
    let mut every: Vec<(&Knob, Vec<&str>)> = Vec::new();
    for technique in Technique::all() {
        for knob in technique.knobs() {
            match every.iter_mut().find(|(known, _)| known.name == knob.name) {
                Some((_, owners)) => owners.push(technique.name()),
                None => every.push((knob, vec![technique.name()])),
            }
        }
    }
    every
}

/// `spp` of `--spp`; a unit at the end of a name may be left out.
fn option((knob, owners): (&'static Knob, Vec<&'static str>)) -> Arg {
    let help = format!("{}: {}; {}", owners.join(", "), knob.about, knob.range);
    let option = Arg::new(knob.name)
        .long(knob.name.replace('_', "-"))
        .value_name(if knob.unit.is_empty() { "VALUE".to_owned() } else { knob.unit.to_uppercase() })
        .help_heading("Knobs")
        .help(help);
    match knob.name.strip_suffix("_s").or(knob.name.strip_suffix("_m")) {
        Some(short) => option.alias(short.replace('_', "-")),
        None => option,
    }
}

/// A number, true, false, or else a word.
fn value(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}

impl clap::Args for Turned {
    fn augment_args(command: Command) -> Command {
        let knob = Arg::new("knob")
            .long("knob")
            .value_name("NAME=VALUE")
            .action(ArgAction::Append)
            .help_heading("Knobs")
            .help("Turn a knob of the technique, as the options below do");
        every().into_iter().map(option).fold(command.arg(knob), Command::arg)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Turned {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let mut turned = BTreeMap::new();
        let refused = |text: String| Error::raw(ErrorKind::ValueValidation, text + "\n");
        let mut turn = |name: &str, text: &str| match turned.insert(name.to_owned(), value(text)) {
            None => Ok(()),
            Some(_) => Err(refused(format!("{name} is turned twice"))),
        };
        for pair in matches.get_many::<String>("knob").into_iter().flatten() {
            let (name, text) = pair.split_once('=').ok_or_else(|| {
                refused(format!(
                    "--knob {pair}: write NAME=VALUE, as in --knob spp=256; kelir technique lists the names"
                ))
            })?;
            turn(name.trim(), text.trim())?;
        }
        for (knob, _) in every() {
            if let Some(text) = matches.get_one::<String>(knob.name) {
                turn(knob.name, text)?;
            }
        }
        Ok(Turned(turned))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
