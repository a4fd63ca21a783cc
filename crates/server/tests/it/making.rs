use crate::client::{Client, config};
use crate::placeholder::Placeholder;
use kelir_house::{Library, Made, Maker, RenderMaker, Task};
use kelir_server::Server;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Fails from the nth stimulus on.
struct Failing {
    inner: Placeholder,
    good: AtomicUsize,
}

impl Maker for Failing {
    fn identity(&self, task: &Task<'_>, library: &Library) -> Result<String, String> {
        self.inner.identity(task, library)
    }

    fn make(
        &self,
        task: &Task<'_>,
        library: &Library,
        progress: &mut (dyn FnMut(f64, &str) + Send),
    ) -> Result<Made, String> {
        if self.good.fetch_sub(1, Ordering::SeqCst) == 0 {
            return Err("the lamp went out".to_owned());
        }
        self.inner.make(task, library, progress)
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_drawn_twice_and_damage_is_drawn_again() {
    let client = Client::ready().await;
    let drawn = || client.drawer.drawn.load(Ordering::SeqCst);
    assert_eq!(drawn(), 6);
    let config = config(client.folder.path(), client.drawer.clone());
    let again = Server::open(&config).await.unwrap();
    again.make_stimuli(&|_| {}).await.unwrap();
    assert_eq!(drawn(), 6, "a restart draws nothing");

    let hash = again.store().study_versions("shadow-puppets").await.unwrap()[0].version.clone();
    let still = again.store().version_stimuli("shadow-puppets", &hash).await.unwrap()[0].sha256.clone();
    std::fs::write(client.folder.path().join("stimuli").join(&still[..2]).join(&still), b"rubbish").unwrap();
    let cookie = client.sign_in().await;
    let text = client.research(&cookie, &format!("/stimuli/{still}")).await;
    assert_eq!(text.status.as_u16(), 503, "damaged bytes are never shown");
    again.make_stimuli(&|_| {}).await.unwrap();
    assert_eq!(drawn(), 7);
    assert_eq!(client.research(&cookie, &format!("/stimuli/{still}")).await.status.as_u16(), 200);

    // Negative control: another size is another stimulus.
    let study = crate::client::STUDY.replace("[64, 36]", "[80, 45]");
    std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    Server::open(&config).await.unwrap().make_stimuli(&|_| {}).await.unwrap();
    assert_eq!(drawn(), 13);
}

#[tokio::test(flavor = "multi_thread")]
async fn an_interrupted_run_goes_on_where_it_stopped() {
    let client = Client::unready().await;
    let failing = Arc::new(Failing { inner: Placeholder::default(), good: AtomicUsize::new(3) });
    let mut config = config(client.folder.path(), failing);
    let server = Server::open(&config).await.unwrap();
    let error = server.make_stimuli(&|_| {}).await.unwrap_err();
    assert!(error.contains("the lamp went out"), "{error}");
    config.maker = client.drawer.clone();
    Server::open(&config).await.unwrap().make_stimuli(&|_| {}).await.unwrap();
    assert_eq!(
        client.drawer.drawn.load(Ordering::SeqCst),
        3,
        "the three that were stored are taken as they are"
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn progress_counts_up_to_the_end() {
    let client = Client::unready().await;
    let events = std::sync::Mutex::new(Vec::new());
    client.server.make_stimuli(&|making| events.lock().unwrap().push(making)).await.unwrap();
    let events = events.into_inner().unwrap();
    assert!(events.windows(2).all(|w| w[0].done <= w[1].done));
    let last = events.last().unwrap();
    assert_eq!((last.study.as_str(), last.done, last.total), ("shadow-puppets", 6, 6));
}

#[tokio::test(flavor = "multi_thread")]
async fn pictures_of_ones_own_take_the_place_of_drawn_ones() {
    let client = Client::unready().await;
    let photo = |width: u32| crate::placeholder::disc([width, 36], 7, 0.0, true);
    let folder = client.folder.path().join("studies/photos");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("a.png"), photo(64)).unwrap();
    std::fs::write(folder.join("b.png"), photo(65)).unwrap();
    std::fs::write(folder.join("c.png"), b"GIF89a").unwrap();
    let study = |a: &str, b: &str| {
        let (stills, _) = crate::client::STUDY.rsplit_once("[[blocks]]").unwrap();
        let files = format!("[conditions.mc]\nfiles = {{ a = \"photos/{a}\", b = \"photos/{b}\" }}");
        stills.replace("[conditions.mc]\ntechnique = \"mc\"", &files)
    };
    let try_with = async |a: &str, b: &str| {
        std::fs::write(client.folder.path().join("studies/shadow-puppets.toml"), study(a, b)).unwrap();
        match Server::open(&config(client.folder.path(), client.drawer.clone())).await {
            Ok(server) => server.make_stimuli(&|_| {}).await,
            Err(error) => Err(error.to_string()),
        }
    };
    try_with("a.png", "a.png").await.unwrap();
    let wrong_size = try_with("a.png", "b.png").await.unwrap_err();
    assert!(wrong_size.contains("65 × 36") && wrong_size.contains("64 × 36"), "{wrong_size}");
    assert!(try_with("a.png", "c.png").await.unwrap_err().contains("neither PNG nor JPEG"));
    // A head that is right and a body that is not: nobody could be shown it.
    let whole = photo(64);
    std::fs::write(folder.join("d.png"), &whole[..whole.len() / 2]).unwrap();
    let cut = try_with("a.png", "d.png").await.unwrap_err();
    assert!(cut.contains("conditions.mc.files.b") && cut.contains("no PNG or JPEG"), "{cut}");
    let missing = try_with("a.png", "none.png").await.unwrap_err();
    assert!(missing.contains("conditions.mc.files.b"), "{missing}");
}

#[tokio::test(flavor = "multi_thread")]
async fn the_renderer_makes_what_the_study_asks_for() {
    let folder = crate::client::folder();
    let camera = "[conditions.photo]\ntechnique = \"mc\"\ncamera = { noise = 0.02, seed = 5 }\n[[blocks]]\nid = \"photos\"\n\
        title = \"p\"\nkind = \"still\"\nconditions = [\"photo\", \"pa\"]\ntarget = \"pa\"\n\
        pairs = [{ id = \"d\", scene = \"../scenes/near.toml\" }]\n";
    let study = format!("{}{camera}", *crate::client::STUDY);
    std::fs::write(folder.path().join("studies/shadow-puppets.toml"), study).unwrap();
    let server = Server::open(&config(folder.path(), Arc::new(RenderMaker::default()))).await.unwrap();
    server.make_stimuli(&|_| {}).await.unwrap();
    let version = server.store().study_versions("shadow-puppets").await.unwrap().remove(0);
    let made = server.store().version_stimuli("shadow-puppets", &version.version).await.unwrap();
    assert_eq!(made.len(), 8);
    let of = |pair: &str, condition: &str| {
        made.iter()
            .find(|s| s.item == pair && s.condition == condition)
            .unwrap_or_else(|| panic!("{pair} {condition}"))
    };
    // PA is measured against the study's MC: one plane, so the two differ by the model error and MC's noise alone.
    let error = &of("a", "pa").provenance["error"];
    let rmse = error["all"]["rmse"].as_f64().unwrap();
    assert!(rmse > 0.0 && rmse < 0.02, "{error}");
    assert!(of("a", "mc").provenance["error"].is_null());
    assert_eq!(of("a", "mc").provenance["technique"], "mc");
    assert_eq!(of("d", "photo").provenance["camera"]["seed"], 5);
    let types = [
        ("a", "pa", "image/png"),
        ("c", "mc", "application/vnd.kelir.animation+json"),
        ("d", "photo", "image/jpeg"),
    ];
    for (pair, condition, media_type) in types {
        let (found, bytes) = server.store().stimulus(&of(pair, condition).sha256).await.unwrap().unwrap();
        assert_eq!(found, media_type);
        // Nothing in the bytes says how they were made.
        for word in ["kelir", "technique", "tEXt", "Monte"] {
            assert!(
                !bytes.windows(word.len()).any(|w| w == word.as_bytes()),
                "{word} in {pair} ({condition})"
            );
        }
    }
    // Pair a and pair d show the same scene by the same technique: it was drawn once.
    assert_eq!(of("a", "pa").sha256, of("d", "pa").sha256);
    assert_ne!(of("a", "pa").sha256, of("a", "mc").sha256);
}

#[test]
fn the_built_in_study_is_good() {
    let library = Library::new(std::path::Path::new("/nonexistent"));
    assert!(library.study_files().contains(&"studies/shadow-puppets.toml".to_owned()));
    let study = library.study("studies/shadow-puppets.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let pairs: Vec<usize> = study.blocks.iter().map(|b| b.items.len()).collect();
    assert_eq!(pairs, [2, 2, 1]);
    assert_eq!(study.question, "Which image is more likely to be real?");
    assert!(study.blocks.iter().all(|b| b.target == "pa"));
    assert!(study.blocks[1].conditions.contains(&"simulated-photo".to_owned()));
    let told = study.texts.debriefing.join(" ");
    assert!(told.contains("simulated photograph"));
}
