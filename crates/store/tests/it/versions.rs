//! Versions of a study: a design and the pixels it shows, written once.

use crate::setting::{IDLE, begin, open, pictures, png};
use image::codecs::png::CompressionType::{Best, Fast};

#[tokio::test(flavor = "multi_thread")]
async fn a_picture_packed_anew_is_the_same_version_and_another_picture_is_not() {
    let (_folder, store, served) = open().await;
    let shown = store.version_stimuli("small", &served.version).await.unwrap();
    assert_eq!(shown.len(), 6);
    let repacked = pictures(&store, &served.study, 1, Best).await;
    assert!(repacked.iter().zip(&served.stimuli).all(|(new, old)| new.sha256 != old.sha256));
    assert_eq!(store.put_version(&served.study, &repacked).await.unwrap(), served.version);
    assert_eq!(store.version_stimuli("small", &served.version).await.unwrap(), shown, "the first stay");
    begin(&store, &served, IDLE).await;
    assert_eq!(store.put_version(&served.study, &repacked).await.unwrap(), served.version);
    assert_eq!(store.version_stimuli("small", &served.version).await.unwrap(), shown, "with a session too");

    let mut other = served.stimuli.clone();
    other[5] = pictures(&store, &served.study, 100, Fast).await.remove(5);
    let version = store.put_version(&served.study, &other).await.unwrap();
    assert_ne!(version, served.version);
    let versions = store.study_versions("small").await.unwrap();
    assert_eq!(versions.iter().map(|v| &v.version).collect::<Vec<_>>(), [&version, &served.version]);
    assert_eq!(versions[0].design_hash, versions[1].design_hash);
    // What is served again comes first again, and is no third version.
    tokio::time::sleep(std::time::Duration::from_millis(5)).await;
    store.put_version(&served.study, &served.stimuli).await.unwrap();
    let again = store.study_versions("small").await.unwrap();
    assert_eq!(again.iter().map(|v| &v.version).collect::<Vec<_>>(), [&served.version, &version]);
    assert_eq!(again[0].first_served_at, versions[1].first_served_at);
}

#[tokio::test(flavor = "multi_thread")]
async fn words_that_nobody_judges_by_make_another_file_of_the_same_version() {
    let (_folder, store, served) = open().await;
    let mut polite = served.study.clone();
    polite.texts.thanks = vec!["Thank you!".to_owned()];
    assert_eq!(store.put_version(&polite, &served.stimuli).await.unwrap(), served.version);
    let [version] = &store.study_versions("small").await.unwrap()[..] else { panic!("one version") };
    assert_eq!((&version.study, &version.file_hash), (&polite, &polite.file_hash()));
    let first = store.study_file("small", &served.study.file_hash()).await.unwrap();
    assert_eq!(first, Some(served.study.clone()), "what was read before is kept");
    let mut asked = served.study.clone();
    asked.question = "Which not?".to_owned();
    assert_ne!(store.put_version(&asked, &served.stimuli).await.unwrap(), served.version);
    assert_eq!(store.put_study_file(&asked).await.unwrap(), asked.file_hash());
    assert_eq!(store.study_file("small", "unknown").await.unwrap(), None);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_no_picture_is_refused_before_it_is_stored() {
    let (folder, store, _) = open().await;
    let before = crate::setting::dump(folder.path()).await;
    let error = store.put_stimulus("image/png", b"no picture".to_vec()).await.unwrap_err();
    assert!(error.to_string().starts_with("a stimulus is no PNG or JPEG"), "{error}");
    assert!(crate::setting::dump(folder.path()).await == before);
    assert_eq!(store.stimulus(&kelir_store::sha256_hex(b"no picture")).await.unwrap(), None);
    let bytes = png(1, Fast);
    let sha256 = kelir_store::sha256_hex(&bytes);
    assert_eq!(store.stimulus(&sha256).await.unwrap(), Some(("image/png".to_owned(), bytes)));
    let info = store.stimulus_info(&sha256).await.unwrap().unwrap();
    assert_eq!((info.size, info.media_type.as_str()), ([16, 16], "image/png"));
    // Python: sha256(b'kelir-pixels/1\n16 16 1 0 false\n' + b'\x01\x01\x01\xff' * 256)
    assert_eq!(info.pixels_sha256, "19c927dbf6e2d53aace160b815791373d52e23d26f3086ce11abacf56a7968ff");
}
