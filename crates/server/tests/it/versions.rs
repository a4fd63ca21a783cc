use crate::client::{Client, STUDY, config, folder};
use crate::placeholder::Placeholder;
use kelir_server::Server;
use serde_json::json;
use std::sync::Arc;

#[tokio::test(flavor = "multi_thread")]
async fn a_version_is_named_by_current_by_its_hash_or_by_the_hashs_beginning() {
    let client = Client::ready().await;
    client.take(json!({}), ["left", "right", "left"]).await;
    let cookie = client.sign_in().await;
    let path = "/api/v1/studies/shadow-puppets/versions";
    let results = async |version: &str, query: &str| {
        client.research(&cookie, &format!("{path}/{version}/results{query}")).await
    };
    let current = results("current", "").await.json();
    let hash = current["version"].as_str().unwrap();
    let with_itself = format!("?with={}", &hash[..9]);
    for (version, query) in
        [(hash, ""), (&hash[..8], ""), (&hash[..63], "?with=all"), (hash, with_itself.as_str())]
    {
        assert!(results(version, query).await.json()["blocks"] == current["blocks"], "{version}{query}");
    }
    let other = if hash.starts_with('0') { "1".repeat(8) } else { "0".repeat(8) };
    let with_other = format!("?with={other}");
    for (version, query, status) in [
        (other.as_str(), "", 404),
        (&hash[..7], "", 400),
        (&format!("{hash}0"), "", 400),
        ("current", &with_other, 404),
    ] {
        assert_eq!(results(version, query).await.status.as_u16(), status, "{version}{query}");
    }
    let versions = client.research(&cookie, path).await.json();
    let version = &versions["items"][0];
    assert_eq!((version["version"].as_str(), &version["is_current"]), (Some(hash), &json!(true)));
    assert_eq!((&version["answers"], &version["stimuli"]), (&json!(3), &json!(6)));
    assert_eq!(version["participants"], json!({ "started": 1, "in_progress": 0, "completed": 1 }));
    assert!(version["first_served_at"].as_str() <= version["last_served_at"].as_str());
    assert_eq!((versions["items"].as_array().unwrap().len(), &versions["next_cursor"]), (1, &json!(null)));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_list_comes_in_pages() {
    let folder = folder();
    for name in ["a", "b", "c"] {
        std::fs::write(folder.path().join(format!("studies/{name}.toml")), STUDY.as_str()).unwrap();
    }
    let drawer = Arc::<Placeholder>::default();
    let server = Server::open(&config(folder.path(), drawer.clone())).await.unwrap();
    let client = Client { server, folder, drawer };
    let cookie = client.sign_in().await;
    let (mut seen, mut cursor) = (Vec::new(), String::new());
    loop {
        let page = client.research(&cookie, &format!("/api/v1/studies?limit=2{cursor}")).await.json();
        seen.extend(page["items"].as_array().unwrap().iter().map(|s| s["id"].as_str().unwrap().to_owned()));
        match page["next_cursor"].as_str() {
            Some(next) => cursor = format!("&cursor={next}"),
            None => break,
        }
    }
    assert_eq!(seen, ["a", "b", "c", "shadow-puppets"]);
}
