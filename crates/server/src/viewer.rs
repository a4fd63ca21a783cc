//! The API's document as one page for people: no script, no network.

use kelir_report::escaped;
use kelir_study::schema::Record;
use serde_json::{Map, Value};

/// The page's style.
pub(crate) const STYLE: &str = include_str!("viewer.css");

/// All that the page may load: its own style.
pub(crate) const POLICY: &str =
    "default-src 'none'; style-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Writes an OpenAPI document as HTML; `style` is where [`STYLE`] is, `json` where the document is.
pub(crate) fn page(document: &Value, style: &str, json: &str) -> String {
    let (title, version) = (text(&document["info"]["title"]), text(&document["info"]["version"]));
    let (mut index, mut sections) = (String::new(), String::new());
    for tag in array(&document["tags"]) {
        let name = text(&tag["name"]);
        index += &format!("<h2>{}</h2>\n<ul>\n", escaped(name));
        sections += &format!("<section>\n<h2>{}</h2>\n{}", escaped(name), prose(&tag["description"]));
        for (path, method, operation) in operations(document) {
            if array(&operation["tags"]).iter().any(|tag| tag == name) {
                let id = text(&operation["operationId"]);
                index += &format!("<li><a href=\"#{0}\">{0}</a></li>\n", escaped(id));
                sections += &operation_of(path, method, operation);
            }
        }
        index += "</ul>\n";
        sections += "</section>\n";
    }
    let secrets: String = object(&document["components"]["securitySchemes"])
        .into_iter()
        .map(|(name, scheme)| {
            let name = escaped(name);
            format!(
                "<li id=\"needs-{name}\"><code>{name}</code>: {}</li>\n",
                inline(text(&scheme["description"]))
            )
        })
        .collect();
    index += "<h2>types</h2>\n<ul>\n";
    sections += "<section>\n<h2>types</h2>\n";
    for (name, schema) in object(&document["components"]["schemas"]) {
        index += &format!("<li><a href=\"#type-{0}\">{0}</a></li>\n", escaped(name));
        sections += &type_of(name, schema);
    }
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title} · API</title>\n\
         <link rel=\"stylesheet\" href=\"{style}\">\n</head>\n<body>\n<nav aria-label=\"Contents\">\n{index}</ul>\n</nav>\n<main>\n\
         <h1>{title} {version}: API</h1>\n{}<p>What requests may need:</p>\n<ul>\n{secrets}</ul>\n<p><a href=\"{json}\">The same as OpenAPI {}</a></p>\n{sections}</section>\n</main>\n</body>\n</html>\n",
        prose(&document["info"]["description"]),
        escaped(text(&document["openapi"])),
        title = escaped(title),
        version = escaped(version),
    )
}

fn operations(document: &Value) -> impl Iterator<Item = (&str, &str, &Value)> {
    object(&document["paths"]).into_iter().flat_map(|(path, item)| {
        object(item).into_iter().map(move |(method, operation)| (path.as_str(), method.as_str(), operation))
    })
}

fn operation_of(path: &str, method: &str, operation: &Value) -> String {
    let id = escaped(text(&operation["operationId"]));
    let mut out = format!(
        "<article id=\"{id}\">\n<h3><span class=\"method\">{}</span> <code>{}</code></h3>\n<p class=\"quiet\">{id}{}</p>\n{}{}",
        escaped(&method.to_uppercase()),
        escaped(path),
        who(operation),
        prose(&operation["summary"]),
        prose(&operation["description"]),
    );
    let parameters = array(&operation["parameters"]).iter().map(|parameter| {
        let place = if parameter["required"] == true { "" } else { ", optional" };
        let name = format!("<code>{}</code>", escaped(text(&parameter["name"])));
        let kind = format!("{}{place}: {}", text(&parameter["in"]), in_words(&parameter["schema"]));
        [name, kind, inline(text(&parameter["description"]))]
    });
    out += &table("Parameters", parameters);
    if let Some((media_type, content)) = object(&operation["requestBody"]["content"]).into_iter().next() {
        out += &format!(
            "<p>Body, as <code>{}</code>: {}</p>\n",
            escaped(media_type),
            in_words(&content["schema"])
        );
    }
    let responses = object(&operation["responses"]).into_iter().map(|(status, response)| {
        let content =
            object(&response["content"]).into_iter().map(|(media_type, content)| match media_type.as_str() {
                "application/json" => in_words(&content["schema"]),
                "application/problem+json" => "<a href=\"#type-Problem\">Problem</a>".to_owned(),
                other => format!("<code>{}</code>", escaped(other)),
            });
        let content: Vec<String> = content.collect();
        [escaped(status), content.join(", "), inline(text(&response["description"]))]
    });
    out += &table("Answers", responses);
    out + "</article>\n"
}

/// Who may ask.
fn who(operation: &Value) -> String {
    let schemes = array(&operation["security"]).iter().flat_map(object).map(|(name, _)| name.as_str());
    match schemes.collect::<Vec<_>>()[..] {
        [] => String::new(),
        [first, ..] => format!(" · needs <a href=\"#needs-{0}\">{0}</a>", escaped(first)),
    }
}

fn type_of(name: &str, schema: &Value) -> String {
    let mut out =
        format!("<article id=\"type-{0}\">\n<h3>{0}</h3>\n{1}", escaped(name), prose(&schema["description"]));
    let constants: Vec<_> = array(&schema["oneOf"]).iter().filter(|part| part["enum"].is_array()).collect();
    let (mut fields, mut also) = (Vec::new(), Vec::new());
    fields_of(schema, &mut fields, &mut also);
    if !constants.is_empty() {
        out += &table(
            "Values",
            constants.into_iter().map(|part| {
                let value: Vec<String> = array(&part["enum"]).iter().map(Value::to_string).collect();
                [
                    format!("<code>{}</code>", escaped(&value.join(", "))),
                    String::new(),
                    inline(text(&part["description"])),
                ]
            }),
        );
    } else if fields.is_empty() && also.is_empty() {
        out += &format!("<p>{}</p>\n", in_words(schema));
    }
    if !also.is_empty() {
        out += &format!("<p>The fields of {}, and:</p>\n", also.join(", "));
    }
    out += &table("Fields", fields);
    out + "</article>\n"
}

/// Rows of an object's own fields, and links to the types whose fields it has too.
fn fields_of(schema: &Value, fields: &mut Vec<[String; 3]>, also: &mut Vec<String>) {
    for part in array(&schema["allOf"]) {
        if part["$ref"].is_string() {
            also.push(in_words(part));
        }
        fields_of(part, fields, also);
    }
    let required = array(&schema["required"]);
    for (name, field) in object(&schema["properties"]) {
        let optional = if required.iter().any(|required| required == name) { "" } else { ", optional" };
        let unit = field["x-unit"].as_str().map(|unit| format!(", in {}", escaped(unit))).unwrap_or_default();
        let described = array(&field["oneOf"]).iter().find_map(|part| part["description"].as_str());
        let description = field["description"].as_str().or(described).unwrap_or_default();
        let kind = format!("{}{unit}{optional}", in_words(field));
        fields.push([format!("<code>{}</code>", escaped(name)), kind, inline(description)]);
    }
}

/// What a value is, with links to the types that are named.
fn in_words(schema: &Value) -> String {
    if let Some(name) = schema["$ref"].as_str().and_then(|path| path.rsplit('/').next()) {
        return format!("<a href=\"#type-{0}\">{0}</a>", escaped(name));
    }
    if let [first, rest @ ..] = array(&schema["oneOf"]) {
        return rest.iter().fold(in_words(first), |words, part| format!("{words} or {}", in_words(part)));
    }
    let whole = escaped(&Record::of_json(schema.clone(), Map::new()).in_words());
    match (schema.get("items"), schema.get("additionalProperties")) {
        (Some(items), _) => format!("{whole}, each {}", in_words(items)),
        (_, Some(values)) if values.is_object() => format!("{whole}, each value {}", in_words(values)),
        _ => whole,
    }
}

fn table(caption: &str, rows: impl IntoIterator<Item = [String; 3]>) -> String {
    let rows: String = rows
        .into_iter()
        .map(|[name, kind, meaning]| {
            format!("<tr><th scope=\"row\">{name}</th><td>{kind}</td><td>{meaning}</td></tr>\n")
        })
        .collect();
    if rows.is_empty() {
        return rows;
    }
    format!("<table>\n<caption>{caption}</caption>\n<tbody>\n{rows}</tbody>\n</table>\n")
}

/// Paragraphs of a description.
fn prose(description: &Value) -> String {
    let paragraphs = text(description).split("\n\n").filter(|paragraph| !paragraph.is_empty());
    paragraphs.map(|paragraph| format!("<p>{}</p>\n", inline(paragraph))).collect()
}

/// Text with `code` in it.
fn inline(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts
        .map(|(i, part)| if i % 2 == 1 { format!("<code>{}</code>", escaped(part)) } else { escaped(part) })
        .collect()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn array(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn object(value: &Value) -> impl IntoIterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_operation_and_type_is_there_and_every_link_leads_somewhere() {
        let document: Value = serde_json::from_str(crate::openapi_json()).unwrap();
        let page = page(&document, "style.css", "openapi.json");
        let named = |attribute: &str| -> BTreeSet<&str> {
            page.split(attribute).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
        };
        let (ids, links) = (named(" id=\""), named("href=\"#"));
        assert_eq!(links, ids, "everything is in the index, and nothing is linked that is not there");
        for (_, _, operation) in operations(&document) {
            assert!(ids.contains(operation["operationId"].as_str().unwrap()));
        }
        assert!(ids.contains("type-Problem") && ids.len() > 100);
        for loaded in ["<script", "style=\"", "<style", "http://", "https://", "<img", "url("] {
            assert!(!page.contains(loaded) && !STYLE.contains(loaded), "{loaded}");
        }
    }

    #[test]
    fn texts_are_escaped() {
        let evil = "<script>`<b>`\"";
        let schema = serde_json::json!({ "description": evil, "properties": { (evil): { "description": evil, "x-unit": evil } } });
        let operation = serde_json::json!({
            "tags": [evil], "operationId": evil, "summary": evil, "description": evil, "security": [{ (evil): [] }],
            "parameters": [{ "name": evil, "in": "path", "description": evil }],
            "responses": { "200": { "description": evil, "content": { (evil): {} } } },
        });
        let document = serde_json::json!({
            "openapi": evil, "info": { "title": evil, "version": evil, "description": evil }, "tags": [{ "name": evil, "description": evil }],
            "paths": { (evil): { "get": operation } }, "components": { "schemas": { (evil): schema } },
        });
        let page = page(&document, "style.css", "openapi.json");
        assert!(!page.contains("<script") && !page.contains("<b>"), "{page}");
        assert!(page.matches("&lt;script&gt;").count() > 20);
    }
}
