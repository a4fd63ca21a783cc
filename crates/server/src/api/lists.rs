//! Lists in pages.

use super::Problem;
use serde::Deserialize;
use utoipa::IntoParams;

/// How much of a list is wanted, and from where on.
#[derive(Clone, Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct ListQuery {
    /// Most items to answer with.
    #[param(minimum = 1, maximum = 200, default = 50)]
    pub limit: Option<usize>,
    /// The `next_cursor` of the page before; opaque.
    pub cursor: Option<String>,
}

/// One page of a list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Page<T> {
    /// The items.
    pub(crate) items: Vec<T>,
    /// What to ask with for the next page; `None` on the last one.
    pub(crate) next_cursor: Option<String>,
}

/// Items of a page where nothing else is asked for.
const USUAL: usize = 50;

impl ListQuery {
    /// The page of `keys` (unique, in the list's order) that is asked for.
    ///
    /// # Errors
    /// The cursor is none of this list.
    pub(crate) fn page<'a>(&self, keys: &[&'a str]) -> Result<Page<&'a str>, Box<Problem>> {
        let start = match &self.cursor {
            None => 0,
            Some(cursor) => {
                let stale =
                    || Problem::parameter("cursor", cursor, "is none of this list's; begin again without it");
                keys.iter().position(|key| cursor_of(key) == *cursor).ok_or_else(stale)? + 1
            }
        };
        let rest = &keys[start..];
        let items = &rest[..rest.len().min(self.limit.unwrap_or(USUAL))];
        let last = items.last().filter(|_| items.len() < rest.len());
        Ok(Page { items: items.to_vec(), next_cursor: last.map(|key| cursor_of(key)) })
    }
}

/// A cursor names the last item seen, so that items that come and go elsewhere move nothing.
fn cursor_of(key: &str) -> String {
    hex::encode(key)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn pages_walk_through_the_whole_list_once() {
        let names: Vec<String> = (0..7).map(|i| format!("study-{i}")).collect();
        let keys: Vec<&str> = names.iter().map(String::as_str).collect();
        for limit in [1, 2, 3, 6, 7, 8] {
            let (mut seen, mut cursor) = (Vec::new(), None);
            loop {
                let page = ListQuery { limit: Some(limit), cursor }.page(&keys).unwrap();
                assert!(page.items.len() <= limit && !page.items.is_empty());
                seen.extend(page.items);
                cursor = page.next_cursor;
                if cursor.is_none() {
                    break;
                }
            }
            assert_eq!(seen, keys, "{limit} a page");
        }
        let all = ListQuery { limit: None, cursor: None };
        assert_eq!(all.page(&[]).unwrap(), Page { items: vec![], next_cursor: None });
        let many: Vec<String> = (0..60).map(|i| i.to_string()).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert_eq!(all.page(&many).unwrap().items.len(), 50);
        let stale = ListQuery { limit: None, cursor: Some("00".to_owned()) };
        assert_eq!(stale.page(&keys).unwrap_err().errors[0].pointer, "/cursor");
    }
}
