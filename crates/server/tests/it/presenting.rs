//! What a session's page gets of its stimuli, and that none of it tells the conditions apart.

use crate::client::{Answer, Client, STUDY, config};
use crate::placeholder::disc;
use axum::http::{Request, StatusCode};
use kelir_server::Server;
use kelir_store::sha256_hex;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

const SIDES: [&str; 2] = ["left", "right"];

async fn asked(client: &Client, method: &str, url: &str, headers: &[(&str, &str)]) -> Answer {
    let mut request = Request::builder().method(method).uri(url);
    for (name, value) in headers {
        request = request.header(*name, *value);
    }
    client.send(request.body(axum::body::Body::empty()).unwrap()).await
}

fn shown<'a>(trial: &'a Value, side: &str) -> [&'a str; 2] {
    ["url", "sha256"].map(|key| trial["shown"][side][key].as_str().unwrap())
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_has_addresses_and_bytes_of_its_own() {
    let client = Client::ready().await;
    let (path, token, state) = client.join(json!({})).await;
    let (other_path, _, other) = client.join(json!({})).await;
    let mut seen = BTreeSet::new();
    for trial in state["trials"].as_array().unwrap().iter().chain(other["trials"].as_array().unwrap()) {
        for side in SIDES {
            let [url, sha256] = shown(trial, side);
            let answer = client.get(url).await;
            assert_eq!(answer.status, StatusCode::OK);
            assert_eq!(answer.header("content-type"), "application/vnd.kelir.stimulus");
            assert_eq!(answer.header("cache-control"), "private, max-age=31536000, immutable");
            assert_eq!(sha256_hex(&answer.bytes), sha256);
            assert!(seen.insert(url.to_owned()) && seen.insert(sha256.to_owned()), "{url} twice");
        }
    }
    assert_eq!(client.call("GET", &path, &token, &Value::Null).await.json()["trials"], state["trials"]);

    // An address is its session's alone, and nothing is found by guessing.
    let [url, _] = shown(&state["trials"][0], "left");
    let end = url.rsplit('/').next().unwrap();
    for wrong in [
        format!("{other_path}/stimuli/{end}"),
        format!("{path}/stimuli/{}", "0".repeat(32)),
        format!("/api/v1/sessions/nobody/stimuli/{end}"),
    ] {
        assert_eq!(client.get(&wrong).await.status, StatusCode::NOT_FOUND, "{wrong}");
    }
    // A server that has forgotten what it told finds it again.
    let restarted = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    let whole = client.get(url).await;
    let client = Client { server: restarted, ..client };
    assert_eq!(client.get(url).await.bytes, whole.bytes);
}

#[tokio::test(flavor = "multi_thread")]
async fn stimuli_are_given_whole_in_part_and_not_again() {
    let client = Client::ready().await;
    let (_, _, state) = client.join(json!({})).await;
    let [url, _] = shown(&state["trials"][2], "left");
    let whole = client.get(url).await;
    let length = whole.bytes.len();
    assert_eq!(
        (whole.header("content-length"), whole.header("accept-ranges")),
        (&*length.to_string(), "bytes")
    );
    let etag = whole.header("etag");
    let same = asked(&client, "GET", url, &[("if-none-match", etag)]).await;
    assert_eq!((same.status, same.bytes.len()), (StatusCode::NOT_MODIFIED, 0));
    let head = asked(&client, "HEAD", url, &[]).await;
    assert_eq!((head.status, head.bytes.len()), (StatusCode::OK, 0));
    assert_eq!(head.header("content-length"), length.to_string());
    for (range, from) in [("bytes=100-", 100), (&*format!("bytes=-{}", 40), length - 40)] {
        let part = asked(&client, "GET", url, &[("range", range), ("if-range", etag)]).await;
        assert_eq!((part.status, &part.bytes[..]), (StatusCode::PARTIAL_CONTENT, &whole.bytes[from..]));
        assert_eq!(part.header("content-range"), format!("bytes {from}-{}/{length}", length - 1));
    }
    let beyond = asked(&client, "GET", url, &[("range", &format!("bytes={length}-"))]).await;
    assert_eq!(beyond.status, StatusCode::RANGE_NOT_SATISFIABLE);
    assert_eq!(beyond.header("content-range"), format!("bytes */{length}"));
    let not_compressed = asked(&client, "GET", url, &[("accept-encoding", "gzip")]).await;
    assert_eq!((not_compressed.header("content-encoding"), not_compressed.bytes.len()), ("", length));
}

#[tokio::test(flavor = "multi_thread")]
async fn stored_files_are_for_researchers_and_for_pages_of_before() {
    let client = Client::ready().await;
    let version = client.version().await;
    let stored = client.server.store().version_stimuli("shadow-puppets", &version).await.unwrap();
    let address = format!("/stimuli/{}", stored[0].sha256);
    assert_eq!(client.get(&address).await.status, StatusCode::UNAUTHORIZED);
    let unknown = format!("/stimuli/{}", "0".repeat(64));
    assert_eq!(client.get(&unknown).await.status, StatusCode::UNAUTHORIZED, "nobody learns what there is");
    let cookie = client.sign_in().await;
    let file = client.research(&cookie, &address).await;
    assert_eq!((file.status, file.header("content-type")), (StatusCode::OK, "image/png"));
    assert_eq!(sha256_hex(&file.bytes), stored[0].sha256);
    assert_eq!(client.research(&cookie, &unknown).await.status, StatusCode::NOT_FOUND);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_packing_that_is_gone_or_damaged_is_made_again() {
    let client = Client::ready().await;
    let (_, _, state) = client.join(json!({})).await;
    let [url, sha256] = shown(&state["trials"][0], "left");
    let store = client.server.store();
    let version = client.version().await;
    for stimulus in store.version_stimuli("shadow-puppets", &version).await.unwrap() {
        let packing = store.packing(&stimulus.sha256).await.unwrap().unwrap();
        let name = packing.packed_sha256;
        let file = client.folder.path().join("stimuli").join(&name[..2]).join(&name);
        if stimulus.condition == "pa" {
            std::fs::remove_file(file).unwrap();
        } else {
            std::fs::write(file, vec![0; packing.size_bytes as usize]).unwrap();
        }
    }
    let restarted = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    let client = Client { server: restarted, ..client };
    assert_eq!(sha256_hex(&client.get(url).await.bytes), sha256);
}

/// A study of one's own photographs (JPEG) beside drawn pictures (PNG).
async fn with_photographs() -> Client {
    let client = Client::unready().await;
    let folder = client.folder.path().join("studies/photos");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, seed) in [("one.jpg", 1), ("two.jpg", 2)] {
        let picture = image::load_from_memory(&disc([64, 36], seed, 0.0, true)).unwrap();
        picture.to_rgb8().save(folder.join(name)).unwrap();
    }
    let files = "[conditions.photographed]\nfiles = { one = \"photos/one.jpg\", two = \"photos/two.jpg\" }";
    let study = STUDY
        .replace(
            "[conditions.mc]\ntechnique = \"mc\"",
            &format!("[conditions.mc]\ntechnique = \"mc\"\n{files}"),
        )
        .replace("id = \"stills\"", "id = \"photographs\"")
        .replacen("conditions = [\"pa\", \"mc\"]", "conditions = [\"pa\", \"photographed\"]", 1)
        .replace("id = \"a\"", "id = \"one\"")
        .replace("id = \"b\"", "id = \"two\"");
    std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let server = Server::open(&config(client.folder.path(), client.drawer.clone())).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    Client { server, ..client }
}

/// All that can be known of an answer but for the pixels: what names it is its length alone.
fn outside(answer: &Answer) -> BTreeMap<String, String> {
    let headers = answer.headers.iter().map(|(name, value)| {
        let value = value.to_str().unwrap();
        let value = if name == "etag" { format!("{} letters", value.len()) } else { value.to_owned() };
        (name.to_string(), value)
    });
    headers.chain([("bytes".to_owned(), answer.bytes.len().to_string())]).collect()
}

/// All that a page is told of a trial, with each side's answer: hashes and addresses by their length alone.
async fn told(client: &Client, trial: &Value) -> (Value, [BTreeMap<String, String>; 2]) {
    let mut told = trial.clone();
    let mut answers = Vec::new();
    for side in SIDES {
        let [url, sha256] = shown(trial, side);
        answers.push(outside(&client.get(url).await));
        told["shown"][side] = json!({ "url": url.len(), "sha256": sha256.len() });
    }
    (told, answers.try_into().unwrap())
}

#[tokio::test(flavor = "multi_thread")]
async fn nothing_but_the_pixels_tells_conditions_apart() {
    let client = with_photographs().await;
    // Slots 0 and 1 see the same with the sides changed.
    let (_, _, state) = client.join(json!({})).await;
    let (_, _, mirrored) = client.join(json!({})).await;
    let plans: Vec<_> = [&state, &mirrored].map(|state| state["trials"].as_array().unwrap().clone()).into();
    assert_eq!((plans[0].len(), plans[1].len()), (3, 3));
    for (one, two) in plans[0].iter().zip(&plans[1]) {
        let ((one, [left, right]), (two, [other_left, other_right])) =
            (told(&client, one).await, told(&client, two).await);
        assert_eq!(one, two, "who sees the sides changed is told the same");
        assert_eq!(left, right, "a side is told like the other");
        assert_eq!((&left, &right), (&other_left, &other_right));
    }
    // Names of blocks, items, conditions and files stay on the server.
    for word in ["photograph", "\"pa\"", "\"mc\"", "\"one\"", "\"two\"", ".jpg", "loop", "technique"] {
        let text = state.to_string().replace("\"loop\":", "");
        assert!(!text.contains(word), "{word} in {text}");
    }
    // Negative control: the stored files are told apart by what this looks at.
    let cookie = client.sign_in().await;
    let version = client.version().await;
    let stored = client.server.store().version_stimuli("shadow-puppets", &version).await.unwrap();
    let mut files = BTreeMap::new();
    for stimulus in stored.iter().filter(|stimulus| stimulus.item == "one") {
        let answer = client.research(&cookie, &format!("/stimuli/{}", stimulus.sha256)).await;
        files.insert(stimulus.condition.clone(), outside(&answer));
    }
    assert_ne!(files["pa"]["content-type"], files["photographed"]["content-type"]);
    assert_ne!(files["pa"]["bytes"], files["photographed"]["bytes"]);
}
