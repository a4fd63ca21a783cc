//! What `kelir study check` says of a study's weight is what its participants download.

use crate::client::{STUDY, config, folder};
use kelir_house::{Library, RenderMaker};
use kelir_server::Server;
use kelir_study::trials::Role;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;

#[tokio::test(flavor = "multi_thread")]
async fn stills_are_weighed_to_the_byte_and_films_about() {
    let folder = folder();
    let study = STUDY.replace("size = [64, 36]\n", "").replacen(
        "[texts]",
        "[display]\nsizes = [[64, 36], [128, 72]]\n[texts]",
        1,
    );
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let server = Server::open(&config(folder.path(), Arc::new(RenderMaker::default()))).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    let client = crate::client::Client { server, folder, drawer: Arc::default() };
    let (_, _, state) = client.join(json!({})).await;
    let mut downloaded = BTreeMap::<(u64, u64), u64>::new();
    for trial in state["trials"].as_array().unwrap() {
        for (shown, width) in [(&trial["shown"], 64), (&trial["larger"][0]["shown"], 128)] {
            for role in [Role::Left, Role::Right] {
                let bytes =
                    client.get(shown[role.as_str()]["url"].as_str().unwrap()).await.bytes.len() as u64;
                *downloaded.entry((trial["block_index"].as_u64().unwrap(), width)).or_default() += bytes;
            }
        }
    }
    // The version as it is stored weighs what was downloaded.
    let cookie = client.sign_in().await;
    let path = "/api/v1/studies/shadow-puppets/versions/current/results";
    let results = client.research(&cookie, path).await.json();
    let all =
        |width: u64| downloaded.iter().filter(|((_, w), _)| *w == width).map(|(_, bytes)| bytes).sum::<u64>();
    let of = |size: [u64; 2]| json!({ "size": size, "bytes": all(size[0]), "is_heavy": false });
    assert_eq!(results["downloads"], json!([of([64, 36]), of([128, 72])]));
    let (library, path) = (Library::new(client.folder.path()), "studies/shadow-puppets.toml");
    let study = library.rehearsed(path).unwrap();
    let weights = library.weights(path, &study).unwrap();
    let told: Vec<_> = weights.iter().map(|w| (w.block.as_str(), w.size[0], w.is_exact)).collect();
    assert_eq!(
        told,
        [("stills", 64, true), ("stills", 128, false), ("loop", 64, false), ("loop", 128, false)]
    );
    assert_eq!(weights[0].bytes, downloaded[&(0, 64)]);
    assert_eq!(
        weights.iter().map(|w| w.begins_after_bytes.is_some()).collect::<Vec<_>>(),
        [false, false, true, true]
    );
    for (weight, block) in weights.iter().zip([0, 0, 1, 1]) {
        let right = downloaded[&(block, u64::from(weight.size[0]))] as f64;
        let part = weight.bytes as f64 / right;
        // Pictures as small as these are mostly edges: a larger one weighs less than as many times more as it has pixels.
        assert!((0.4..2.5).contains(&part), "{weight:?} for {right}");
    }
}
