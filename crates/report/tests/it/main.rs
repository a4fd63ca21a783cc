//! Reports as a whole: the numbers in them against R's, what hostile and empty studies make of them.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod explored;
mod fixture;
mod pages;

use fixture::{Study, hostile, levels, paper, svg_disks, triangle};
use kelir_report::{Document, Figures, Sample, StudyReport, csv, html, markdown, numbers, text};

/// t, its p, and the p of the binomial test of all choices and of the sign test, by R 4.2.2: `t.test(rep(0:2, c(12, 14, 6)), mu = 1)`,
/// `binom.test(sum(x), 64)`, `binom.test(sum(x > 1), sum(x != 1))` and so on; then `p.adjust(p, "holm")`.
const R: [(&str, [f64; 5]); 3] = [
    (
        "stills",
        [
            -1.4375905768565216,
            0.16056863389412473,
            0.16864291143970364,
            0.2378845214843751,
            0.16056863389412473,
        ],
    ),
    (
        "photographs",
        [
            4.20883424647321,
            0.00020378219167228206,
            7.733076881287021e-5,
            0.0008554458618164061,
            0.0006113465750168462,
        ],
    ),
    (
        "animation",
        [
            -3.9834823795432888,
            0.0003668638983360312,
            0.0013187271542847213,
            0.0013187271542847213,
            0.0007337277966720624,
        ],
    ),
];

/// The p of a block's statistic that begins so, and its value, from the tidy rows.
fn row(report: &StudyReport, block: &str, statistic: &str) -> (f64, Option<f64>) {
    let rows = numbers(report);
    let found: Vec<_> = rows
        .iter()
        .filter(|n| n.sample == Sample::Screened && n.block == block && n.statistic.starts_with(statistic))
        .collect();
    assert_eq!(found.len(), 1, "{block}: {statistic}");
    (found[0].value.unwrap(), found[0].p)
}

fn close(ours: f64, theirs: f64) -> bool {
    (ours - theirs).abs() <= 1e-12 * theirs.abs()
}

#[test]
fn the_papers_counts_give_what_r_gives() {
    let report = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report();
    for (block, [t, p, binomial, sign, holm]) in R {
        let (ours, ours_p) = row(&report, block, "t (df");
        assert!(close(ours, t) && close(ours_p.unwrap(), p), "{block}: {ours} {ours_p:?}");
        assert!(close(row(&report, block, "exact binomial").1.unwrap(), binomial), "{block}");
        assert!(close(row(&report, block, "sign test").1.unwrap(), sign), "{block}");
        assert!(close(row(&report, block, "t, p corrected").1.unwrap(), holm), "{block}");
    }
    // Negative control: one participant who chose otherwise is seen in every one of them.
    let other = paper([[13, 13, 6], [3, 10, 19], [26, 7, 0]]).report();
    for (statistic, theirs) in [("t (df", 0.16056863389412473), ("exact binomial", 0.16864291143970364)] {
        assert!(!close(row(&other, "stills", statistic).1.unwrap(), theirs), "{statistic}");
    }
}

#[test]
fn every_form_says_the_same() {
    let report = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report();
    let document = Document::of(&report);
    let (page, plain, table) = (html(&document), text(&document), csv(&report));
    let md = markdown(&document, &Figures::Folder("report-figures".to_owned()));
    // What is shown of t and p, rounded here by hand from R's digits.
    for shown in ["−1.4376", "0.1606", "4.2088", "2.04 × 10⁻⁴", "−3.9835", "3.67 × 10⁻⁴"] {
        for form in [&page, &plain, &md.text] {
            assert!(form.contains(shown), "{shown} is not in {form}");
        }
    }
    // Every number of the page's block tables is in the CSV, digit for digit, and the other way round.
    let in_csv = fixture::cells(&table);
    let in_page: Vec<&str> =
        page.split("<data value=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    for number in numbers(&report).iter().filter(|n| !n.block.is_empty() && n.sample == Sample::Screened) {
        let exact = number.value.unwrap().to_string();
        assert!(in_page.contains(&exact.as_str()) && in_csv.contains(&exact), "{number:?}");
    }
    assert!(!in_page.contains(&"-1.4375905768565218"), "the search tells neighbouring numbers apart");
    // The terminal's lines fit it, and no paragraph of methods is among them.
    assert!(plain.lines().all(|line| line.chars().count() <= 100), "{plain}");
    assert!(!plain.contains("SHA-256") && page.contains("SHA-256") && md.text.contains("SHA-256"));
    // Figures: within the page; beside the text or within it.
    assert_eq!((page.matches("<svg").count(), md.files.len()), (document.figures().count(), 7));
    for (path, svg) in &md.files {
        assert!(md.text.contains(&format!("(<{path}>)")) && svg.starts_with("<svg"), "{path}");
    }
    let whole = markdown(&document, &Figures::Embedded);
    assert!(whole.files.is_empty() && whole.text.matches("data:image/svg+xml;base64,PHN2Z").count() == 7);
    // The same answers give the same bytes.
    assert_eq!(html(&Document::of(&paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report())), page);
    // Nothing is fetched and nothing runs.
    for address in ["src=", "href=", "url(", "@import", "<script", "<link"] {
        assert!(!page.contains(address), "{address}");
    }
}

#[test]
fn the_headline_says_what_was_and_what_was_not_shown() {
    let headline = |counts, within: &str| {
        let study = Study { within: within.to_owned(), ..paper(counts) };
        let page = text(&Document::of(&study.report()));
        let one_line = page.split_whitespace().collect::<Vec<_>>().join(" ");
        let (found, rest) = one_line.split_once("Not shown:").unwrap();
        (found.to_owned(), rest.split("Participants ─").next().unwrap().to_owned())
    };
    let counts = [[12, 14, 6], [3, 10, 19], [26, 7, 0]];
    let (found, not_shown) = headline(counts, "");
    assert!(
        found.contains("not significantly different from half the time, t(31) = −1.438, p = 0.1606"),
        "{found}"
    );
    assert!(
        found.contains("more often than half the time, t(31) = 4.209")
            && found.contains("less often than half the time, t(32)")
    );
    assert!(
        not_shown.contains("the study file states no bound within which a share would count"),
        "{not_shown}"
    );
    assert!(not_shown.contains("2.1 times likelier under no effect"), "{not_shown}");
    assert!(not_shown.contains("below d = 0.51 is missed"), "{not_shown}");
    assert_eq!(
        not_shown.matches("participants cannot tell").count(),
        1,
        "the other two blocks did show a difference"
    );
    // Within a tenth of the share the same counts show nothing.
    let (_, not_shown) = headline(counts, "0.1");
    assert!(not_shown.contains("within the study's bound of ±0.1 on the share is not shown"), "{not_shown}");
    // Half a choice of two is a quarter of the share: the first block is equivalent within that, which is found and not among what is not shown.
    let (found, not_shown) = headline(counts, "0.25");
    assert!(
        found.contains("equivalent to it within the study's bound of ±0.25 on the share, p = 0.0114"),
        "{found}"
    );
    assert!(!not_shown.contains("participants cannot tell"), "{not_shown}");
    // What is not defined is not shown either, and stays in the list.
    let (_, not_shown) = headline([[0, 0, 32], [3, 10, 19], [26, 7, 0]], "0.1");
    assert!(
        not_shown.contains("Stills: whether participants can tell pa from mc, by the planned t-test: all participants chose the same number"),
        "{not_shown}"
    );
}

/// The report's text in one line.
fn said(report: &StudyReport) -> String {
    text(&Document::of(report)).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn no_interval_of_a_share_has_a_width_of_nothing() {
    // Everybody alike: .025^(1/32) = .891, of participants and not of choices; everybody in half: about a half.
    let alike = said(&paper([[0, 0, 32], [0, 32, 0], [26, 7, 0]]).report());
    assert!(alike.contains("in 100% of 64 choices (95% interval 89% to 100%)"), "{alike}");
    assert!(alike.contains("in 50% of 64 choices (95% interval 38% to 62%)"), "{alike}");
    assert!(!alike.contains("100% to 100%") && !alike.contains("50% to 50%"), "{alike}");
    assert!(alike.contains("No robust logit: the cluster-robust interval has no solution"), "{alike}");
}

#[test]
fn the_scales_sentence_counts_what_the_table_holds() {
    for (circular, straight) in [(6, 14), (0, 5), (0, 20)] {
        let report = triangle(circular, straight).report();
        let scale = report.report.scale.as_ref().unwrap();
        let mut order: Vec<_> = scale.conditions.iter().collect();
        order.sort_by(|a, b| b.jod.total_cmp(&a.jod));
        let sure = scale.differences.iter().filter(|d| d.p_holm < 0.05).count();
        let plain = said(&report);
        assert!(
            plain.contains(&format!("from the highest place to the lowest: {} (", order[0].condition)),
            "{plain}"
        );
        assert!(
            plain.contains(&format!("{sure} of 3 differences have p < 0.05 after Holm's correction")),
            "{plain}"
        );
        assert!(
            plain.contains("The scale takes the choices of 3 blocks together: pairs of 3 stills;"),
            "{plain}"
        );
        // Five who agree have a sign test's p of 2/2⁵; twenty, a bound from the patterns that were tried.
        assert_eq!(plain.contains("0.0625"), straight == 5, "{plain}");
        assert_eq!(plain.contains("≤ 0.0001"), circular + straight == 20, "{plain}");
        // Who all agree give no interval, with the reason.
        let intervals = scale.differences.iter().filter(|d| d.low.is_some()).count();
        assert_eq!((intervals > 0, scale.note.is_some()), (circular > 0, true), "{scale:?}");
        assert!(plain.contains("they chose alike, which tells their number"), "{plain}");
    }
}

#[test]
fn an_end_beyond_every_level_is_said_and_the_other_printed() {
    let mut report = levels().report();
    let fit = report.report.blocks[0].psychometric.as_mut().unwrap().fit.as_mut().unwrap();
    (fit.at[0].low, fit.at[0].high) = (Some(3.069283499483749), None);
    let page = html(&Document::of(&report));
    assert!(page.contains(">3.0693 to beyond<"), "{page}");
    assert!(page.contains("its upper end is beyond every level"), "{page}");
    let table = csv(&report);
    let row = table.lines().find(|line| line.contains("level at a share of")).unwrap();
    assert!(row.contains(",3.069283499483749,,0.95,"), "{row}");
}

#[test]
fn figures_show_the_numbers_of_the_tables() {
    let report = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report();
    let document = Document::of(&report);
    let figure = |name: &str| document.figures().find(|f| f.name == name).unwrap_or_else(|| panic!("{name}"));
    // Disks of the choices, from the top down: block, its pairs, block …, on one linear axis.
    let shares = [
        row(&report, "stills", "share of pa").0,
        row(&report, "stills", "still-a: share").0,
        row(&report, "stills", "still-b: share").0,
        row(&report, "photographs", "share of pa").0,
        row(&report, "photographs", "photo-a: share").0,
        row(&report, "photographs", "photo-b: share").0,
        row(&report, "animation", "share of pa").0,
    ];
    let disks = svg_disks(&figure("choices").svg);
    assert_eq!(disks.len(), shares.len());
    let scale = (disks[3].0 - disks[0].0) / (shares[3] - shares[0]);
    assert!(scale > 100.0, "an axis of {scale} px");
    for (disk, share) in disks.iter().zip(shares) {
        assert!((disk.0 - disks[0].0 - scale * (share - shares[0])).abs() < 0.15, "{disk:?} {share}");
    }
    // Error against preference: three of the five pairs have a measured stimulus, each named once.
    let errors = &figure("errors").svg;
    for pair in ["still-a", "still-b", "photo-a"] {
        assert_eq!(errors.matches(&format!(">\n{pair}\n<")).count(), 1, "{errors}");
    }
    assert!(!errors.contains("loop"), "its stimulus has no error");
    // photo-a's error, 0.004, is less than √2 times its reference's noise of 0.003; the other two are well above.
    let plain = text(&document);
    assert!(plain.contains("The measured error of 1 stimulus is mostly the noise"), "{plain}");
}

#[test]
fn a_psychometric_function_is_drawn_with_its_data() {
    let report = levels().report();
    let document = Document::of(&report);
    let figure = document.figures().find(|f| f.name == "psychometric-levels").unwrap();
    // Dots fall from the first level to the last as the shares do: 96, 95, 84, 72, 58, 50 of 100.
    let disks = svg_disks(&figure.svg);
    let shares = [0.96, 0.95, 0.84, 0.72, 0.58, 0.50];
    assert_eq!(disks.len(), 6);
    let scale = (disks[5].1 - disks[0].1) / (shares[5] - shares[0]);
    for (disk, share) in disks.iter().zip(shares) {
        assert!((disk.1 - disks[0].1 - scale * (share - shares[0])).abs() < 0.15, "{disk:?} {share}");
    }
    // psignifit 4.3 on these numbers: threshold 3.183, interval 3.082 to 3.331 (x negated there), width 1.001, lapse rate .029.
    for (statistic, golden) in [("threshold, F", 3.183), ("width", 1.001), ("lapse", 0.029)] {
        let (ours, _) = row(&report, "levels", statistic);
        assert!((ours - golden).abs() < 1e-3, "{statistic}: {ours}");
    }
    assert!(html(&document).contains("Schütt"), "the paper of the method is cited");
    let without = html(&Document::of(&paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]).report()));
    assert!(!without.contains("Schütt"), "and not where it was not used");
}

#[test]
fn circles_are_counted_and_said() {
    // One triad a participant; of three conditions it is either a circle (ζ = 0) or none (ζ = 1).
    for (circular, straight, share, zeta) in
        [(6, 14, "6 of 20 (30%;", "0.70"), (0, 20, "0 of 20 (0%;", "1.00")]
    {
        let report = triangle(circular, straight).report();
        let rows = numbers(&report);
        let found = rows.iter().find(|n| n.statistic.starts_with("circular triads")).unwrap();
        assert_eq!((found.value, found.n), (Some(circular as f64), Some(20)));
        let plain = text(&Document::of(&report));
        assert!(plain.contains(&format!("Circular triads: {share}")), "{plain}");
        assert!(plain.contains(&format!("coefficient of consistence {zeta}")), "{plain}");
        assert!(html(&Document::of(&report)).contains("Babington Smith"));
    }
}

#[test]
fn nothing_from_a_study_file_is_markup() {
    let report = hostile().report();
    let document = Document::of(&report);
    let page = html(&document);
    assert!(page.contains("&lt;script&gt;"), "the title is there");
    // Outside the tags that kelir writes there is no bracket: every tag's name is one of these.
    let known = [
        "!doctype",
        "html",
        "head",
        "meta",
        "title",
        "style",
        "body",
        "main",
        "header",
        "h1",
        "h2",
        "h3",
        "p",
        "section",
        "ul",
        "li",
        "table",
        "caption",
        "thead",
        "tbody",
        "tr",
        "th",
        "td",
        "data",
        "span",
        "figure",
        "figcaption",
        "svg",
        "desc",
        "g",
        "rect",
        "path",
        "circle",
        "text",
    ];
    for tag in page.split('<').skip(1) {
        let name: String = tag
            .trim_start_matches('/')
            .chars()
            .take_while(|c| c.is_ascii_alphanumeric() || *c == '!')
            .collect();
        assert!(known.contains(&name.as_str()), "<{name} …");
    }
    assert!(!page.contains("onerror=\"") && !page.contains("javascript:\""));
    let md = markdown(&document, &Figures::Embedded).text;
    assert!(!md.contains("<script") && !md.contains("<img") && md.contains("&lt;script&gt;"), "{md}");
    assert!(!text(&document).chars().any(|c| c.is_control() && c != '\n'), "no terminal is steered");
    let table = csv(&report);
    let begins: Vec<char> = fixture::cells(&table).iter().filter_map(|c| c.chars().next()).collect();
    assert!(!begins.contains(&'=') && !begins.contains(&'@'), "{table}");
}

#[test]
fn an_empty_study_says_so_and_has_no_figures() {
    let report = Study::default().report();
    let document = Document::of(&report);
    let plain = text(&document);
    assert!(
        plain.contains("0 began.")
            && plain.contains("Of the participants who are judged, none answered every pair."),
        "{plain}"
    );
    assert!(!plain.contains("Not shown"));
    assert_eq!(document.figures().count(), 0);
    for form in [plain, html(&document), csv(&report), markdown(&document, &Figures::Embedded).text] {
        assert!(!form.contains("NaN") && !form.contains("inf"), "{form}");
    }
    // All alike: no t, and the exact test says what there is to say: 2 · 2⁻³² = 4.66e-10.
    let alike = text(&Document::of(&paper([[0, 0, 32], [3, 10, 19], [26, 7, 0]]).report()));
    let one_line = alike.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        one_line.contains("t is not defined, but the exact sign test gives p = 4.66 × 10⁻¹⁰."),
        "{one_line}"
    );
    // One answer alone is no error either.
    let one = Study { people: vec![vec![("still-a", "pa", 900.0)]], ..Study::default() }.report();
    assert!(text(&Document::of(&one)).contains("none answered every pair, 1 answered some"));
}

#[test]
fn the_excluded_are_named_and_the_results_given_both_ways() {
    // Five who never look, always choosing the photograph's rival in 50 ms, beside the paper's 33.
    let mut study = paper([[12, 14, 6], [3, 10, 19], [26, 7, 0]]);
    study.screening = "min_rt_ms = 200".to_owned();
    for _ in 0..5 {
        study.people.push(vec![
            ("still-a", "pa", 50.0),
            ("still-b", "pa", 50.0),
            ("photo-a", "pa", 50.0),
            ("photo-b", "pa", 50.0),
            ("loop-a", "pa", 50.0),
        ]);
    }
    let report = study.report();
    assert_eq!(report.excluded.len(), 5);
    let (t, _) = row(&report, "stills", "t (df");
    assert!(close(t, R[0].1[0]), "the judged are the paper's participants: {t}");
    let plain = text(&Document::of(&report));
    assert!(
        plain.contains("5 answers too fast, 0 allowed") && plain.contains("With and without the excluded"),
        "{plain}"
    );
    // R 4.2.2: t.test(rep(0:2, c(12, 14, 11)), mu = 1): t = -0.2058 on 36 degrees of freedom.
    let everybody = numbers(&report);
    let everybody: Vec<f64> = everybody
        .iter()
        .filter(|n| n.sample == Sample::Everybody && n.block == "stills" && n.statistic.starts_with("t (df"))
        .filter_map(|n| n.value)
        .collect();
    assert!(everybody.len() == 1 && close(everybody[0], fixture::T_OF_12_14_11), "{everybody:?}");
    let csv = csv(&report);
    assert!(csv.lines().any(|line| line.starts_with("everybody,stills,t-test,")), "{csv}");
}
