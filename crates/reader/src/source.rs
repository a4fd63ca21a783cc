//! What is read, and what was found wrong with it.

use std::cell::{OnceCell, RefCell};
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::asked::{Asked, Noted};
use crate::place::{Lines, Place};
use crate::problem::{Problem, Problems};
use crate::words::shorten;

/// One reading, of a file and of those that it names: what is wrong with them.
#[derive(Debug, Default)]
pub struct Reading {
    problems: RefCell<Vec<Problem>>,
    warnings: RefCell<Vec<Problem>>,
    asked: Option<RefCell<Asked>>,
}

impl Reading {
    /// A reading that notes what is asked for: reference pages are made of it.
    pub fn noting() -> Reading {
        Reading { asked: Some(RefCell::default()), ..Reading::default() }
    }

    /// A file of this reading; `name` is how messages call it.
    pub fn source<'a>(&'a self, name: &'a str, text: &'a str) -> Source<'a> {
        Source { name, text, lines: OnceCell::new(), reading: self }
    }

    /// Whether nothing was found wrong so far.
    pub fn is_sound(&self) -> bool {
        self.problems.borrow().is_empty()
    }

    /// What may be a mistake, though nothing is wrong with it; handed out once.
    pub fn take_warnings(&self) -> Vec<Problem> {
        self.warnings.take()
    }

    /// Every problem.
    pub fn into_problems(self) -> Vec<Problem> {
        self.problems.into_inner()
    }

    /// What was read, or every problem. Panics where nothing was read and nothing is wrong.
    ///
    /// # Errors
    /// Every problem.
    pub fn end<T>(self, read: Option<T>) -> Result<T, Problems> {
        match read {
            Some(read) if self.is_sound() => Ok(read),
            _ => Err(Problems::new(self.into_problems())),
        }
    }

    /// What was asked for; nothing unless it is noted.
    pub fn asked(&self) -> Asked {
        self.asked.as_ref().map(|asked| asked.borrow().clone()).unwrap_or_default()
    }

    pub(crate) fn noted(&self, path: &str, what: Noted<'_>) {
        if let Some(asked) = &self.asked {
            asked.borrow_mut().note(path, what);
        }
    }
}

/// A file being read.
#[derive(Debug)]
pub struct Source<'a> {
    name: &'a str,
    text: &'a str,
    lines: OnceCell<Lines>,
    pub(crate) reading: &'a Reading,
}

impl<'a> Source<'a> {
    /// The document; nothing where it is no TOML, whose every error is collected.
    pub(crate) fn parse(&self) -> Option<DeValue<'a>> {
        let (table, errors) = DeTable::parse_recoverable(self.text);
        for error in &errors {
            let place = error.span().map(|span| self.place(span.start));
            let field = place.map_or(String::new(), |place| place.to_string());
            let value = error.span().and_then(|span| self.text.get(span)).and_then(shorten);
            let rule = format!("is no TOML: {}", error.message().replace('\n', ", "));
            self.add(Problem { place, ..self.problem(field, value, rule) });
        }
        errors.is_empty().then(|| DeValue::Table(table.into_inner()))
    }

    /// Collects a problem of the file as a whole, or of a field whose value is not at hand.
    pub fn refuse(&self, field: &str, value: Option<String>, rule: impl Into<String>) {
        self.add(self.problem(field.to_owned(), value, rule.into()));
    }

    pub(crate) fn refuse_at(
        &self,
        span: Option<&Range<usize>>,
        field: String,
        value: Option<String>,
        rule: String,
    ) {
        self.add(self.problem_at(span, field, value, rule));
    }

    pub(crate) fn warn_at(
        &self,
        span: Option<&Range<usize>>,
        field: String,
        value: Option<String>,
        about: String,
    ) {
        self.reading.warnings.borrow_mut().push(self.problem_at(span, field, value, about));
    }

    fn problem_at(
        &self,
        span: Option<&Range<usize>>,
        field: String,
        value: Option<String>,
        rule: String,
    ) -> Problem {
        let place = span.map(|span| self.place(span.start));
        Problem { place, ..self.problem(field, value, rule) }
    }

    pub(crate) fn text_at(&self, span: Option<&Range<usize>>) -> &'a str {
        span.and_then(|span| self.text.get(span.clone())).unwrap_or("")
    }

    fn problem(&self, field: String, value: Option<String>, rule: String) -> Problem {
        // A decoder's message may quote the file: no line break or control character gets through.
        Problem::new(self.name, field, value, rule.replace(char::is_control, " "))
    }

    fn add(&self, problem: Problem) {
        self.reading.problems.borrow_mut().push(problem);
    }

    fn place(&self, offset: usize) -> Place {
        self.lines.get_or_init(|| Lines::of(self.text)).place(offset.min(self.text.len()))
    }
}
