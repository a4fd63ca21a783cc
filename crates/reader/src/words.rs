//! Values and names in messages.

/// `a.b`, with a key that is no bare key quoted.
pub(crate) fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { shorten(&format!("{key:?}")).unwrap_or_default() };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// A value on one line, shortened to what a message can carry; `None` for nothing.
pub fn shorten(text: &str) -> Option<String> {
    const MOST: usize = 80;
    let mut line = String::new();
    let mut length = 0;
    for c in text.chars() {
        let c = if c.is_whitespace() { ' ' } else { c };
        if !(c == ' ' && (line.is_empty() || line.ends_with(' '))) && !c.is_control() {
            line.push(c);
            length += 1;
        }
        if length > MOST {
            line.pop();
            line.push('…');
            break;
        }
    }
    let line = line.trim_end().to_owned();
    (!line.is_empty()).then_some(line)
}

/// `a, b and c`, at most twenty of them.
pub fn list<S: AsRef<str>>(names: &[S]) -> String {
    let mut names: Vec<&str> = names.iter().map(S::as_ref).collect();
    let more = names.len().saturating_sub(20);
    names.truncate(20);
    match names.split_last() {
        None => "none".to_owned(),
        Some(_) if more > 0 => format!("{} and {more} more", names.join(", ")),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// ` (did you mean x?)` when a known name is close.
pub fn did_you_mean<S: AsRef<str>>(name: &str, known: &[S]) -> String {
    let nearest = known.iter().map(|k| (edits(name, k.as_ref()), k.as_ref())).min();
    match nearest {
        Some((distance, known)) if distance <= 1 + known.len() / 4 => format!(" (did you mean {known}?)"),
        _ => String::new(),
    }
}

/// Levenshtein distance; names longer than 64 characters are far from everything.
fn edits(a: &str, b: &str) -> usize {
    if a.len() > 64 || b.len() > 64 {
        return usize::MAX;
    }
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}
