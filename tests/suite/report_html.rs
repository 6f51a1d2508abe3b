//! The report as a page: whole in itself, well formed, true to the figures, safe against names.

use crate::scene::CUBE;
use crate::shapes::{ORANGE, boxes};
use glam::DVec3;
use pillarforest::carve::{Forest, Repairs};
use pillarforest::certify::camouflage::{Camouflage, CurvePoint};
use pillarforest::certify::conflicts::{Disturbance, Trouble};
use pillarforest::certify::coverage::{Cause, Coverage, Gap, ModelCoverage};
use pillarforest::certify::tolerance::{Confirmed, Movement, Rift, Tolerance, Way, WorstCut};
use pillarforest::compile::{Build, build};
use pillarforest::contest::Contest;
use pillarforest::diag::Diagnostic;
use pillarforest::index::CellId;
use pillarforest::ladder::{Ladder, short};
use pillarforest::mesh::{Resolving, Solid};
use pillarforest::render::ViewPictures;
use pillarforest::report::html::{Exhibits, ViewExhibit, print_sheet};
use pillarforest::report::{
    CertificateReport, ModelShare, PrintReport, Proof, Report, SolidCheck, SolidReport, ViewReport,
};
use pillarforest::scene;
use pillarforest::words;
use serde_json::Value;

const ODD: &str = "a \"fish\" & <more> 'of' it</script>";

/// A cube in two blocks.
const TWO_BLOCKS: &str = r#"(
    title: "Cube & <blocks>",
    models: [(name: "cube", file: "cube.obj", place: Fit(height: 20, spin: 30, at: (0, 0, 15)))],
    views: [(name: "front", eye: (0, -300, 40), models: ["cube"])],
    pillars: [(shape: Rectangle(width: 24, depth: 12), height: 60, places: At([(-12, -8), (12, 8)]))],
    output: (picture_size: 64),
)"#;

fn built(text: &str) -> Build {
    let read = |_: &str| -> Result<Vec<u8>, Diagnostic> { Ok(CUBE.into()) };
    let scene = scene::resolve(text, &read).expect("a scene").value;
    build(&scene, &|_, _| {}, &|| false).expect("a forest")
}

fn bytes<'a>(build: &'a Build, path: &str) -> Option<&'a [u8]> {
    let file = build.files.iter().find(|f| f.path == path)?;
    Some(&file.bytes)
}

fn page(build: &Build) -> &str {
    std::str::from_utf8(bytes(build, "report.html").expect("a page")).expect("UTF-8")
}

/// Different figures everywhere, so that none can stand in for another.
fn certificate() -> CertificateReport {
    let confirmed = |x: f64| {
        Some(Confirmed {
            predicted_arcmin: x,
            measured_arcmin: x + 0.0625,
        })
    };
    CertificateReport {
        bound_violation_mm: 1.25e-9,
        clamp_mm: 2.5e-8,
        nothing_mm: 1e-6,
        relief_front_mm: 4.75,
        relief_back_mm: 1.625,
        at_limit: 0.125,
        order_inversions: 41,
        crossings: None,
        proof: Some(Proof {
            duality_gap_rel: 5.37e-8,
            primal_residual: 6.5e-12,
            dual_residual: 7.25e-11,
        }),
        not_an_optimum: None,
        coverage: 0.987_654_3,
        reaching: 0.976_543_2,
        models: vec![ModelShare {
            name: ODD.into(),
            solid_angle_sr: 0.060_087,
            coverage: 0.95,
            reaching: 0.94,
        }],
        gaps: vec![Gap {
            arcmin2: 33.75,
            place_mm: [1.5, -2.5, 3.25],
            right_deg: -0.625,
            up_deg: 1.125,
            cause: Cause::PillarTooShort,
            support: Some(ODD.into()),
            view: None,
            wanted_mm: Some(2.375),
        }],
        small_gaps: 17,
        small_gaps_arcmin2: 0.4375,
        contests: vec![Contest {
            with_view: ODD.into(),
            support: "pillar 3".into(),
            with_support: "pillar 5".into(),
            arcmin2: 55.5,
            place_mm: [4.5, -1e-9, 6.5],
            lost_by: ODD.into(),
        }],
        contested_left_arcmin2: 0.875,
        conflicts: vec![Disturbance {
            trouble: Trouble::Blocked,
            with_view: Some(ODD.into()),
            support: Some("pillar 9".into()),
            arcmin2: 66.25,
            place_mm: [7.5, 8.5, 9.5],
        }],
        small_conflicts_arcmin2: 18.25,
        filled_arcmin2: 3.0625,
        rays: 131_626,
        tolerance: Tolerance {
            eye_tolerance_mm: Movement {
                side: Some(0.75),
                up: None,
                fore: Some(10.125),
            },
            one_picture_mm: Movement {
                side: Some(3.875),
                up: Some(17.5),
                fore: None,
            },
            stereo_distance_mm: Some(1234.5),
            worst_cuts: vec![WorstCut {
                movement: Way::Side,
                angle_arcmin: 2.0,
                moved_mm: 0.75,
                place_mm: [11.5, 12.5, 13.5],
                supports: ["pillar 1".into(), ODD.into()],
                gap: confirmed(1.9375),
                overlap: confirmed(2.0625),
                cut: Rift {
                    direction: DVec3::Y,
                    normal: DVec3::X,
                    distances: [200.0, 204.0],
                },
            }],
            ..Tolerance::default()
        },
    }
}

fn report() -> Report {
    let view = |name: &str| ViewReport {
        name: name.into(),
        certificate: Some(certificate()),
        ..ViewReport::default()
    };
    Report {
        scene: ODD.into(),
        failures: vec![format!("view {ODD}: broken"), "another one".into()],
        warnings: vec![format!("mind {ODD}")],
        views: vec![view(ODD)],
        solid: Some(SolidReport {
            volume_mm3: 195_137.5,
            checks: vec![SolidCheck::at_most(ODD, 3, 0)],
            ..SolidReport::default()
        }),
        camouflage: vec![Camouflage {
            view: ODD.into(),
            half_likeness_deg: Some(20.0625),
            worst_off_view_deg: Some(45.0),
            worst_likeness: Some(0.234_375),
            curve: vec![CurvePoint {
                angle_deg: 0.0,
                likeness: 0.53125,
                agreement: 1.0,
                overlap: 0.53125,
                mean_error_deg: 0.5,
            }],
        }],
        ..Report::default()
    }
}

/// Bytes of base64 with padding.
fn decoded(text: &str) -> Vec<u8> {
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => panic!("{c} is no letter of base64"),
    };
    assert_eq!(text.len() % 4, 0);
    let four = |four: &[u8]| {
        let kept = four.iter().filter(|c| **c != b'=').count();
        let bits = (0..4).fold(0, |bits: u32, k| {
            bits << 6
                | if k < kept {
                    u32::from(value(four[k]))
                } else {
                    0
                }
        });
        bits.to_be_bytes()[1..kept].to_vec()
    };
    text.as_bytes().chunks(4).flat_map(four).collect()
}

/// Pictures within the page, decoded.
fn pictures(html: &str) -> Vec<Vec<u8>> {
    let sources = html.split("src=\"data:image/png;base64,").skip(1);
    sources
        .map(|rest| decoded(&rest[..rest.find('"').unwrap()]))
        .collect()
}

/// Tags of a page, in order, without what stands in style and script. Panics where quotes or angle brackets do not match.
fn tags(html: &str) -> Vec<&str> {
    let (mut rest, mut tags) = (html, Vec::new());
    while let Some(start) = rest.find('<') {
        assert!(
            !rest[..start].contains('>'),
            "a stray >: {}",
            &rest[..start]
        );
        let mut quoted = false;
        let end = rest[start..].find(|c| {
            quoted ^= c == '"';
            c == '>' && !quoted
        });
        let tag = &rest[start + 1..start + end.expect("an end of the tag")];
        assert!(!tag.contains('<'), "{tag}");
        tags.push(tag);
        rest = &rest[start + tag.len() + 2..];
        if tag == "style" || tag == "script" {
            rest = &rest[rest.find(&format!("</{tag}>")).expect("its end")..];
        }
    }
    tags
}

/// Every element is closed in its turn.
fn assert_well_formed(html: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in tags(html) {
        let name = tag.split([' ', '\n', '/']).next().unwrap();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed));
        } else if !tag.ends_with('/') && !["meta", "img", "input", "!DOCTYPE"].contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

/// Nothing is loaded from anywhere.
fn assert_self_contained(html: &str) {
    let without = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for outward in [
        "http:", "https:", "file:", "@import", "url(", "<link", "<iframe", "srcset", "fetch(",
    ] {
        assert!(!without.contains(outward), "{outward}");
    }
    for (attribute, allowed) in [("src=\"", "data:image/png;base64,"), ("href=\"", "#")] {
        for rest in without.split(attribute).skip(1) {
            assert!(rest.starts_with(allowed), "{attribute}{}", &rest[..30]);
        }
    }
    assert!(html.contains("default-src 'none'"));
    let anchors = html.split("href=\"#").skip(1);
    for id in anchors.map(|rest| &rest[..rest.find('"').unwrap()]) {
        assert!(html.contains(&format!("id=\"{id}\"")), "{id}");
    }
}

/// All numbers of a JSON value.
fn numbers(value: &Value, into: &mut Vec<f64>) {
    match value {
        Value::Number(n) => into.extend(n.as_f64()),
        Value::Array(list) => list.iter().for_each(|v| numbers(v, into)),
        Value::Object(map) => map.values().for_each(|v| numbers(v, into)),
        _ => {}
    }
}

/// Exact values of the page's figures.
fn figures(html: &str) -> Vec<f64> {
    let values = html.split("<data value=\"").skip(1);
    values
        .map(|rest| rest[..rest.find('"').unwrap()].parse().expect("a number"))
        .collect()
}

#[test]
fn a_build_gives_a_page_that_is_whole_in_itself() {
    let build = built(TWO_BLOCKS);
    let html = page(&build);
    assert_well_formed(html);
    assert_self_contained(html);
    assert!(html.contains("<h1>Cube &amp; &lt;blocks&gt;</h1>"));
    assert!(
        html.contains("✓ ok.") && !html.contains("not ok"),
        "{:?}",
        build.failures
    );
    for (svg, section) in [("plan.svg", "plan"), ("camouflage.svg", "camouflage")] {
        let svg = std::str::from_utf8(bytes(&build, svg).unwrap()).unwrap();
        assert!(html.contains(svg) && html.contains(&format!("<section id=\"{section}\">")));
    }
    let shown = pictures(html);
    assert_eq!(shown.len(), 4);
    let sheet = tiny_skia::Pixmap::decode_png(bytes(&build, "views/front.png").unwrap()).unwrap();
    for (k, png) in shown[..3].iter().enumerate() {
        let panel = tiny_skia::Pixmap::decode_png(png).expect("a picture");
        assert_eq!((panel.width(), panel.height()), (64, 64));
        // Panels stand 2 px apart: three hundredths of their side, rounded.
        let left = 2 + k as u32 * 66;
        let same = |x, y| panel.pixel(x, y) == sheet.pixel(left + x, 2 + y);
        assert!((0..64).all(|y| (0..64).all(|x| same(x, y))), "panel {k}");
    }
    assert_eq!(shown[3], bytes(&build, "views/front-lights.png").unwrap());
    for file in build.files.iter().filter(|f| f.path != "report.html") {
        assert!(
            html.contains(&format!(">{}</th>", file.path)),
            "{}",
            file.path
        );
    }
    assert!(html.contains(&format!("pillarforest {}", env!("CARGO_PKG_VERSION"))));
    let again = built(TWO_BLOCKS);
    assert!(page(&again) == html, "two builds differ");
}

#[test]
fn every_figure_of_the_certificates_stands_in_the_page() {
    for (html, report) in [
        {
            let build = built(TWO_BLOCKS);
            let report = serde_json::from_slice(bytes(&build, "report.json").unwrap()).unwrap();
            (page(&build).to_owned(), report)
        },
        {
            let report = report();
            (
                report.html(&Exhibits::default()),
                serde_json::to_value(&report).unwrap(),
            )
        },
    ] {
        let shown = figures(&html);
        let mut wanted = Vec::new();
        let report: Value = report;
        for view in report["views"].as_array().unwrap() {
            numbers(&view["certificate"], &mut wanted);
            numbers(&view["normal_error_deg"], &mut wanted);
        }
        for of_view in report["camouflage"].as_array().unwrap() {
            for key in ["half_likeness_deg", "worst_off_view_deg", "worst_likeness"] {
                numbers(&of_view[key], &mut wanted);
            }
        }
        assert!(wanted.len() > 20);
        for figure in wanted {
            assert!(shown.contains(&figure), "{figure}");
        }
    }
}

#[test]
fn shown_figures_are_rounded_but_never_to_a_lie() {
    let html = report().html(&Exhibits::default());
    for text in [
        "<data value=\"1.25e-9\">below 0.001\u{202F}mm</data>",
        "<data value=\"5.37e-8\">5.4 × 10<sup>\u{2212}8</sup></data>",
        "<data value=\"0.9876543\">98.76\u{202F}%</data>",
        "<data value=\"0.95\">95.00\u{202F}%</data>",
        "<data value=\"131626\">131\u{202F}626</data>",
        "<data value=\"-0.625\">\u{2212}0.62°</data>",
        "<data value=\"-1e-9\">0.0</data>",
        "as far as it likes",
        "the pillar is too short",
        "something stands before the relief",
    ] {
        assert!(html.contains(text), "{text}");
    }
    let almost = Report {
        views: vec![ViewReport {
            hit_share: Some(0.999_999),
            ..ViewReport::default()
        }],
        ..Report::default()
    };
    assert!(
        almost
            .html(&Exhibits::default())
            .contains(">99.99\u{202F}%<")
    );
}

#[test]
fn names_are_only_names() {
    let report = report();
    let pictures = ViewPictures {
        sheet: vec![],
        panels: [vec![1], vec![1, 2], vec![1, 2, 3]],
    };
    let view = ViewExhibit {
        colour: ORANGE,
        pictures: Some(&pictures),
        lights: Some(&[9]),
    };
    let html = report.html(&Exhibits {
        views: vec![view],
        files: vec![(ODD, 1)],
        ..Exhibits::default()
    });
    assert_well_formed(&html);
    assert_self_contained(&html);
    assert!(!html.contains("<more>") && !html.contains("\"fish\""));
    assert_eq!(html.matches("</script>").count(), 1);
    let safe = "a &quot;fish&quot; &amp; &lt;more&gt; &apos;of&apos; it&lt;/script&gt;";
    // Title twice, failure, warning, overview, the view's head and caption, its pictures, lists, file.
    assert!(html.matches(safe).count() > 12);
    assert!(html.contains(&format!("alt=\"{safe}: the model\"")));
    for base64 in ["AQ==", "AQI=", "AQID"] {
        assert!(html.contains(&format!("base64,{base64}\"")), "{base64}");
    }
}

#[test]
fn the_verdict_is_shown_with_all_that_does_not_hold() {
    let html = report().html(&Exhibits::default());
    assert!(html.contains("✗ not ok.") && !html.contains("✓ ok."));
    assert!(html.contains("it&lt;/script&gt;: broken</li>"));
    assert!(html.contains("<li>another one</li>"));
    assert!(html.contains("<li>mind a "));
    let good = Report {
        ok: true,
        ..Report::default()
    };
    let html = good.html(&Exhibits::default());
    assert!(html.contains("✓ ok.") && !html.contains("Warnings"));
}

#[test]
fn it_stands_without_what_is_optional() {
    let nothing = Report::default().html(&Exhibits::default());
    assert_well_formed(&nothing);
    assert!(!nothing.contains("<section") && !nothing.contains("<table"));
    let bare = ["lights", "camouflage", "plan", "views"]
        .iter()
        .fold(TWO_BLOCKS.to_owned(), |text, what| {
            scene::set(&text, &format!("output.{what}=false")).expect("a field")
        });
    let build = built(&bare);
    let html = page(&build);
    assert_well_formed(html);
    for section in ["plan", "camouflage"] {
        assert!(
            !html.contains(&format!("<section id=\"{section}\">")),
            "{section}"
        );
    }
    assert!(!html.contains("In real light"));
    // The slider is not for the files' sake.
    assert_eq!(pictures(html).len(), 3);
    let none = built(&scene::set(&bare, "output.report_html=false").expect("a field"));
    assert!(bytes(&none, "report.html").is_none());
}

#[test]
fn the_print_sheet_has_a_line_for_each_check() {
    let checks = [
        PrintReport {
            check: "wall".into(),
            place: [1.5, -2.0, 3.0],
            value_mm: 0.85,
            wanted_mm: 0.9,
            limit_mm: 0.64,
            ok: true,
            note: ODD.into(),
        },
        PrintReport {
            check: "bed".into(),
            value_mm: 300.0,
            wanted_mm: 256.0,
            limit_mm: 256.0,
            ..PrintReport::default()
        },
    ];
    let html = print_sheet(&checks);
    assert_well_formed(&html);
    for text in [
        "<h2>Print sheet</h2>",
        ">0.85\u{202F}mm<",
        ">256.00\u{202F}mm<",
        "✓ holds",
        "! see here",
        ">\u{2212}2.0<",
        "it&lt;/script&gt;",
    ] {
        assert!(html.contains(text), "{text}");
    }
    assert_eq!(html.matches("<tr>").count(), 3);
    assert_eq!(print_sheet(&[]), "");
}

/// A forest of two boxes side by side, in which some cells were given up.
fn apart() -> Forest {
    let two = [
        (DVec3::ZERO, DVec3::ONE),
        (DVec3::splat(2.0), DVec3::splat(3.0)),
    ];
    let whole = Solid::new(boxes(&two)).expect("two boxes");
    Forest {
        bare: whole.clone(),
        reliefs: vec![None],
        given_up: vec![[1, 2, 3].map(CellId).to_vec()],
        standing: vec![whole.mesh().clone()],
        repairs: Repairs {
            filled: 7,
            dropped_cells: 3,
            braces: 1,
            crumbs_mm3: 0.25,
            resolving: Resolving {
                pairs: 5,
                rounds: 2,
                moved_mm: 0.0005,
            },
        },
        whole,
    }
}

#[test]
fn checks_of_the_solid_are_counts_that_can_be_wrong_and_repairs_are_none() {
    let solid = SolidReport::of_forest(&apart());
    let found: Vec<(usize, usize, bool)> = (solid.checks.iter())
        .map(|c| (c.found, c.limit, c.passed))
        .collect();
    // Defects, parts, cells given up.
    assert_eq!(found, [(0, 0, true), (2, 1, false), (3, 0, false)]);
    assert_eq!(solid.repairs.filled_corners, 7);
    assert_eq!(solid.repairs.crumbs_mm3, 0.25);
    assert_eq!(
        (solid.repairs.crossings, solid.repairs.crossing_rounds),
        (5, 2)
    );
    assert_eq!(solid.repairs.moved_mm, 0.0005);
}

#[test]
fn a_ladder_is_told_with_a_note_unless_its_first_rung_held() {
    let name = "position on the bed";
    let all = [("a", 0), ("b", 2), ("c", 0)].map(|(p, k)| Ladder::new(name, Some(p), k, 5));
    let kept = short(all.to_vec());
    // All that held at once are one line without a place.
    assert_eq!(
        kept,
        [
            Ladder::new(name, None, 0, 5),
            Ladder::new(name, Some("b"), 2, 5)
        ]
    );
    let report = Report {
        ladders: kept,
        solid: Some(SolidReport::default()),
        ..Report::default()
    };
    let told: Value = serde_json::from_str(&report.json()).expect("json");
    assert_eq!(told["ladders"][1]["rung"], 2);
    let page = report.html(&Exhibits::default());
    assert_well_formed(&page);
    assert!(page.contains("position on the bed, b: way 3 of 5 held"));
    assert!(!page.contains("way 1 of 5"));
}

#[test]
fn what_is_no_pillar_is_not_called_one() {
    let coverage = Coverage {
        models: vec![ModelCoverage {
            name: "fish".into(),
            solid_angle_sr: 1e-4,
            carried_sr: 5e-5,
        }],
        gaps: vec![Gap {
            cause: Cause::NoPillar,
            ..certificate().gaps[0].clone()
        }],
        small_gaps: 0,
        small_gaps_arcmin2: 0.0,
    };
    for carrier in ["pillar", "support"] {
        let told = words::coverage::warnings("left", &coverage, carrier);
        assert!(!told.is_empty());
        let all = format!("{told:?}");
        assert_eq!(all.contains("pillar stands"), carrier == "pillar", "{all}");
    }
}
