//! Pictures of plans: the sheet, the trade-off, the search as a film and as a strip.

use crate::plans::{Case, creatures, crowd, mended, nothing, tell};
use glam::DVec2;
use pillarforest::diagram::{Plan, planning};
use pillarforest::planner::{Pillar, Trade};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// An element, with the number of the innermost one around it: its own if others are in it.
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
    group: usize,
}

impl Element {
    fn get(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    fn values(&self) -> Vec<&str> {
        self.get("values").split(';').collect()
    }

    /// Coordinates of a path.
    fn points(&self) -> Vec<DVec2> {
        let numbers: Vec<f64> = self
            .get("d")
            .split(|c: char| c.is_ascii_alphabetic() || c == ' ')
            .filter(|t| !t.is_empty())
            .map(|t| t.parse().unwrap())
            .collect();
        numbers.chunks(2).map(|c| DVec2::new(c[0], c[1])).collect()
    }

    /// Middle of what it draws.
    fn middle(&self) -> DVec2 {
        let points = self.points();
        let lo = points.iter().copied().reduce(DVec2::min).unwrap();
        let hi = points.iter().copied().reduce(DVec2::max).unwrap();
        (lo + hi) / 2.0
    }
}

/// All elements of a document in order; fails if it is not well-formed.
fn elements(svg: &str) -> Vec<Element> {
    let mut reader = Reader::from_str(svg);
    let (mut list, mut groups, mut opened) = (Vec::new(), vec![0], 0);
    let element = |e: &BytesStart, group: usize| Element {
        name: String::from_utf8(e.name().as_ref().to_vec()).unwrap(),
        attributes: e
            .attributes()
            .map(|a| {
                let a = a.unwrap();
                let key = String::from_utf8(a.key.as_ref().to_vec()).unwrap();
                (key, a.unescape_value().unwrap().into_owned())
            })
            .collect(),
        group,
    };
    loop {
        match reader.read_event().expect("well-formed") {
            Event::Eof => break,
            Event::Start(e) => {
                opened += 1;
                groups.push(opened);
                list.push(element(&e, opened));
            }
            Event::Empty(e) => list.push(element(&e, groups[groups.len() - 1])),
            Event::End(_) => {
                groups.pop();
            }
            _ => {}
        }
    }
    assert_eq!(groups.len(), 1, "every element ends");
    list
}

fn sheet(case: &Case) -> Plan {
    let (plan, tell) = ((&case.brief, &case.planned), tell(&case.views));
    planning::sheet("A <title> & more", &case.views, plan, &tell)
}

fn strip(case: &Case) -> Plan {
    let (plan, tell) = ((&case.brief, &case.planned), tell(&case.views));
    planning::strip("A <title> & more", &case.views, plan, &tell)
}

fn trade(case: &Case) -> Plan {
    planning::trade("A <title> & more", &case.brief, &case.planned)
}

fn film(case: &Case) -> String {
    let (plan, tell) = ((&case.brief, &case.planned), tell(&case.views));
    planning::animation("A <title> & more", &case.views, plan, &tell)
}

/// The colour of a view's pillars: its own, three tenths of white in it.
fn fill(rgb: [u8; 3]) -> String {
    let [r, g, b] = rgb.map(|c| (f64::from(c) + 0.3 * (255.0 - f64::from(c))).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn pillars_of<'a>(list: &'a [Element], colour: &str) -> Vec<&'a Element> {
    list.iter()
        .filter(|e| e.name == "path" && e.get("fill") == colour && e.get("aria-label").is_empty())
        .collect()
}

fn owned(pillars: &[Pillar], view: usize) -> Vec<DVec2> {
    let own = pillars.iter().filter(|p| p.owner == Some(view));
    own.map(|p| p.at).collect()
}

fn labels(list: &[Element]) -> Vec<&str> {
    let labels = list.iter().map(|e| e.get("aria-label"));
    labels.filter(|l| !l.is_empty()).collect()
}

fn labels_of(page: &Plan) -> Vec<String> {
    let list = elements(&page.svg());
    labels(&list).into_iter().map(str::to_owned).collect()
}

#[test]
fn both_maps_show_every_pillar_where_it_stands_at_one_scale() {
    let case = creatures();
    let list = elements(&sheet(&case).svg());
    let (first, last) = (&case.planned.frames[0], case.planned.frames.last().unwrap());
    let mut scales = Vec::new();
    for (v, view) in case.views.iter().enumerate() {
        let shapes = pillars_of(&list, &fill(view.colour));
        let (left, right) = (owned(&first.pillars, v), owned(&last.pillars, v));
        assert_eq!(shapes.len(), left.len() + right.len(), "{}", view.name);
        let (on_left, on_right) = shapes.split_at(left.len());
        for (places, drawn) in [(left, on_left), (right, on_right)] {
            for k in 1..places.len() {
                let (a, b) = (places[k] - places[0], drawn[k].middle() - drawn[0].middle());
                scales.push(b.length() / a.length());
                // Upwards on the page is against y.
                assert!(a.normalize().distance(DVec2::new(b.x, -b.y).normalize()) < 1e-2);
            }
        }
    }
    let most = scales.iter().copied().fold(0.0, f64::max);
    let least = scales.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(most / least < 1.01, "{least} to {most}");
}

#[test]
fn every_view_has_its_name_its_letter_and_its_figures() {
    let case = creatures();
    let list = elements(&sheet(&case).svg());
    let labels = labels(&list);
    let count = |text: &str| labels.iter().filter(|l| **l == text).count();
    for (v, view) in case.views.iter().enumerate() {
        // At the eye on both maps and in the table.
        assert_eq!(count(&view.name), 3);
        let letter = view.name[..1].to_uppercase();
        let on_pillars: usize = [0, case.planned.frames.len() - 1]
            .map(|k| owned(&case.planned.frames[k].pillars, v).len())
            .iter()
            .sum();
        assert_eq!(count(&letter), on_pillars + 1, "{letter}");
        assert!(count(&format!("{:.1}°", 50.0 + v as f64)) > 0);
    }
    assert!(count("never") > 0 && count("A <title> & more") == 1);
    let ended =
        "29 pillars (4 fixed)   ·   12,000 tries   ·   ended as nothing better was found for long";
    assert_eq!(count(ended), 1);
}

#[test]
fn views_with_the_same_letter_have_numbers() {
    let case = crowd(3, 2, "same ");
    let list = elements(&sheet(&case).svg());
    let labels = labels(&list);
    for v in 1..=3 {
        let at_eyes = format!("{v}  same {v}");
        assert_eq!(labels.iter().filter(|l| **l == at_eyes).count(), 2);
        assert!(labels.iter().filter(|l| **l == v.to_string()).count() > 4);
    }
}

/// Far corners of the ranges in a colour: where its eye's rays end.
fn far_corners(list: &[Element], rgb: [u8; 3]) -> Vec<DVec2> {
    let [r, g, b] = rgb;
    let colour = format!("#{r:02x}{g:02x}{b:02x}");
    let ranges = list
        .iter()
        .filter(|e| e.get("fill") == colour && e.get("fill-opacity") == "0.26");
    let far = ranges.flat_map(|e| {
        let points = e.points();
        let half = points.len() / 2;
        points.into_iter().take(half)
    });
    far.collect()
}

#[test]
fn ranges_end_on_the_outlines_of_their_own_pillars() {
    let mut case = creatures();
    // The layout at the end has no faults of sight: let the search have nothing else.
    let last = case.planned.frames.pop().unwrap();
    case.planned.frames = vec![last];
    let list = elements(&sheet(&case).svg());
    for view in &case.views {
        let pillars = pillars_of(&list, &fill(view.colour));
        let bodies: Vec<(DVec2, f64)> = pillars
            .iter()
            .map(|e| (e.middle(), e.middle().distance(e.points()[0])))
            .collect();
        let far = far_corners(&list, view.colour);
        assert!(far.len() > pillars.len());
        for p in far {
            let off = bodies.iter().map(|(c, r)| (c.distance(p) - r).abs());
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 0.01, "{} ends {off} mm off its pillars", view.name);
        }
    }
}

#[test]
fn every_fault_is_marked_on_its_map() {
    for case in [creatures(), mended()] {
        let list = elements(&sheet(&case).svg());
        let (first, last) = (&case.planned.frames[0], case.planned.frames.last().unwrap());
        let crosses: Vec<&Element> = list
            .iter()
            .filter(|e| e.get("stroke") == "#c4121e" && e.get("fill") == "none")
            .filter(|e| !e.get("aria-label").is_empty())
            .collect();
        let texts: Vec<&str> = crosses.iter().map(|e| e.get("aria-label")).collect();
        let tell = tell(&case.views);
        let [of_first, of_last] = [first, last].map(&tell);
        let marks = of_first.iter().chain(&of_last);
        let wanted: Vec<&str> = marks.map(|m| m.1.as_str()).collect();
        assert!(!wanted.is_empty());
        assert_eq!(texts, wanted);
        for (marks, crosses) in [
            (&of_first, &crosses[..of_first.len()]),
            (&of_last, &crosses[of_first.len()..]),
        ] {
            at_the_same_places(marks, crosses);
        }
    }
}

#[test]
fn what_meets_no_pillar_or_another_s_is_red() {
    let case = creatures();
    let list = elements(&sheet(&case).svg());
    let past = list
        .iter()
        .filter(|e| e.get("fill") == "#c4121e" && e.get("fill-opacity") == "0.18");
    let foreign = list
        .iter()
        .filter(|e| e.get("stroke") == "#c4121e" && e.get("stroke-width") == "0.648");
    let (mut no_pillar, mut another_s) = (0, 0);
    for frame in [&case.planned.frames[0], &case.planned.frames[30]] {
        for (v, runs) in frame.runs.iter().enumerate() {
            let met = || {
                runs.iter()
                    .map(|r| r.obstacle.map(|i| frame.pillars[i].owner))
            };
            no_pillar += met().filter(Option::is_none).count();
            another_s += met().flatten().filter(|o| *o != Some(v)).count();
        }
    }
    assert!(no_pillar > 0 && another_s > 0);
    // One more in the key.
    assert_eq!(past.count(), no_pillar + 1);
    assert_eq!(foreign.count(), another_s);
}

/// Crosses lie to each other as the marks do.
fn at_the_same_places(marks: &[(DVec2, String)], crosses: &[&Element]) {
    let Some(((first, _), cross)) = marks.first().zip(crosses.first()) else {
        return;
    };
    let scale = |k: usize| {
        let on_page = crosses[k].middle() - cross.middle();
        (marks[k].0 - *first).length() / on_page.length()
    };
    let scales: Vec<f64> = (1..crosses.len())
        .map(scale)
        .filter(|s| s.is_finite())
        .collect();
    for s in &scales {
        assert!((s / scales[0] - 1.0).abs() < 0.02, "{scales:?}");
    }
}

#[test]
fn animations_have_a_value_for_every_frame_and_rest_on_the_last() {
    let case = creatures();
    let list = elements(&film(&case));
    let animations: Vec<&Element> = list
        .iter()
        .filter(|e| e.name.starts_with("animate"))
        .collect();
    assert!(animations.len() > case.planned.pillars.len());
    for e in animations {
        let values = e.values();
        let times: Vec<f64> = e
            .get("keyTimes")
            .split(';')
            .map(|t| t.parse().unwrap())
            .collect();
        // Of 31 frames 24 are shown.
        assert_eq!(values.len(), 24 + 1);
        assert_eq!(times.len(), values.len());
        assert!(times.windows(2).all(|t| t[0] < t[1]) && times[0] == 0.0 && times[24] == 1.0);
        assert_eq!(times[23], 0.75, "six of eight seconds");
        assert_eq!((e.get("dur"), e.get("repeatCount")), ("8s", "indefinite"));
        assert_eq!(values[23], values[24]);
        if e.get("calcMode") == "spline" {
            assert_eq!(e.get("keySplines").split(';').count(), 24);
        }
        // As written, the group is as in the last frame.
        let group = list
            .iter()
            .find(|g| g.name == "g" && g.group == e.group)
            .unwrap();
        match e.get("attributeName") {
            "transform" => assert_eq!(group.get("transform"), format!("translate({})", values[24])),
            "opacity" => {
                let shown = group.attributes.get("opacity").map_or("1", String::as_str);
                assert_eq!(shown, values[24]);
            }
            other => panic!("{other}"),
        }
    }
}

/// Where the film shows pillars of a colour at a frame.
fn at_frame(list: &[Element], colour: &str, frame: usize) -> Vec<DVec2> {
    let place = |e: &&Element| {
        let of_group = |name: &str| {
            let animated = list
                .iter()
                .find(|a| a.group == e.group && a.get("attributeName") == name && a.name != "g");
            animated.map(|a| a.values()[frame].to_owned())
        };
        let group = list
            .iter()
            .find(|g| g.name == "g" && g.group == e.group)
            .unwrap();
        let still = group.get("transform").trim_start_matches("translate(");
        let shift = of_group("transform").unwrap_or(still.trim_end_matches(')').to_owned());
        let (x, y) = shift.split_once(' ').unwrap();
        let seen = of_group("opacity").is_none_or(|o| o == "1");
        seen.then(|| DVec2::new(x.parse().unwrap(), y.parse().unwrap()))
    };
    pillars_of(list, colour).iter().filter_map(place).collect()
}

#[test]
fn the_film_shows_every_frame_s_pillars_where_they_stand() {
    // Pillars come, go and change places in the list.
    let mut case = crowd(2, 9, "view ");
    for (k, frame) in case.planned.frames.iter_mut().enumerate() {
        frame.pillars.rotate_left(5 * k % 18);
        frame.pillars.truncate(18 - k % 4);
        frame.runs.iter_mut().for_each(Vec::clear);
    }
    let list = elements(&film(&case));
    for (k, frame) in case.planned.frames.iter().enumerate() {
        for (v, view) in case.views.iter().enumerate() {
            let mut drawn = at_frame(&list, &fill(view.colour), k);
            let mut wanted = owned(&frame.pillars, v);
            assert_eq!(drawn.len(), wanted.len(), "frame {k}");
            drawn.sort_by(|a, b| a.x.total_cmp(&b.x));
            wanted.sort_by(|a, b| a.x.total_cmp(&b.x));
            let scale = (drawn[1] - drawn[0]).length() / (wanted[1] - wanted[0]).length();
            for (d, w) in drawn.iter().zip(&wanted) {
                let (d, w) = (*d - drawn[0], scale * (*w - wanted[0]));
                assert!(d.distance(DVec2::new(w.x, -w.y)) < 0.05, "frame {k}");
            }
        }
    }
}

#[test]
fn one_frame_stands_still() {
    let mut case = crowd(1, 1, "x");
    case.planned.frames.truncate(1);
    assert!(!film(&case).contains("<animate"));
    let pillar = fill(case.views[0].colour);
    assert_eq!(pillars_of(&elements(&strip(&case).svg()), &pillar).len(), 1);
    assert_eq!(pillars_of(&elements(&sheet(&case).svg()), &pillar).len(), 2);
}

#[test]
fn the_strip_has_six_maps_from_the_first_frame_to_the_last() {
    let case = creatures();
    let list = elements(&strip(&case).svg());
    let shapes: usize = case
        .views
        .iter()
        .map(|v| pillars_of(&list, &fill(v.colour)).len())
        .sum();
    assert_eq!(shapes, 6 * case.planned.pillars.len());
    let labels = labels(&list);
    for tries in ["0 tries", "2,400 tries", "12,000 tries"] {
        assert!(labels.iter().any(|l| l.starts_with(tries)), "{tries}");
    }
}

#[test]
fn the_trade_off_falls_in_steps_and_names_what_was_chosen() {
    let case = creatures();
    let list = elements(&trade(&case).svg());
    let dots: Vec<DVec2> = list
        .iter()
        .filter(|e| e.get("fill") == "#0072b2" && e.get("fill-opacity").is_empty())
        .map(Element::middle)
        .collect();
    assert_eq!(dots.len(), case.planned.trade.len());
    // Tolerances that double lie side by side at one distance.
    let steps: Vec<f64> = dots.windows(2).map(|d| d[1].x - d[0].x).collect();
    assert!(
        steps
            .iter()
            .all(|s| (s - steps[0]).abs() < 0.01 && *s > 1.0)
    );
    let drops = dots.windows(2).map(|d| d[1].y - d[0].y);
    for (k, drop) in drops.enumerate() {
        let wanted = case.planned.trade[k].hidden_deg - case.planned.trade[k + 1].hidden_deg;
        let all = case.planned.trade[0].hidden_deg - case.planned.trade[8].hidden_deg;
        assert!((drop / (dots[8].y - dots[0].y) - wanted / all).abs() < 1e-3);
    }
    let labels = labels(&list);
    assert!(labels.contains(&"chosen: 50.4° at 3.0 mm"));
    assert!(labels.contains(&"tolerance of the eye in mm, logarithmic"));
}

#[test]
fn a_narrow_trade_off_has_a_linear_axis() {
    let mut case = creatures();
    case.planned.trade = [2.0, 3.0, 4.0]
        .map(|tolerance_mm| Trade {
            tolerance_mm,
            hidden_deg: 60.0 - tolerance_mm,
            chosen: false,
        })
        .to_vec();
    let list = elements(&trade(&case).svg());
    let labels = labels(&list);
    assert!(labels.contains(&"tolerance of the eye in mm"));
    assert!(!labels.iter().any(|l| l.starts_with("chosen")));
    assert!(!labels.contains(&"start"), "the search began with faults");
    case.planned.frames[0].faults = Vec::new();
    assert!(labels_of(&trade(&case)).contains(&"start".to_owned()));
}

#[test]
fn mending_is_shown_with_what_was_moved() {
    let case = mended();
    let list = elements(&sheet(&case).svg());
    let labels = labels(&list);
    for text in ["As given", "Mended", "where a given pillar stood", "new"] {
        assert!(labels.contains(&text), "{text}");
    }
    let note = "model turned \u{2212}5.7°, scaled by 1.050, shifted by 1.5, \u{2212}2.0 mm";
    assert!(labels.contains(&note));
}

#[test]
fn odd_plans_have_pictures_too() {
    let title = "A title that is very much longer than what a page has room for ".repeat(3);
    let mut endless = crowd(2, 3, "\"<&>' ");
    endless.planned.worth[0].tolerance_mm = [f64::INFINITY; 2];
    endless.planned.frames[1].tolerance_mm = f64::INFINITY;
    endless.planned.frames[2].hidden_deg = f64::NAN;
    let mut other = creatures();
    other.planned.trade[8].tolerance_mm = f64::INFINITY;
    other.planned.frames.truncate(2);
    other.planned.regions.truncate(1);
    let long = crowd(12, 16, "a rather long name of a view, number ");
    for case in [nothing(), crowd(1, 1, "x"), endless, other, long, mended()] {
        let Case {
            views,
            brief,
            planned,
        } = &case;
        let (plan, tell) = ((brief, planned), tell(views));
        let pages = [
            planning::sheet(&title, views, plan, &tell),
            planning::trade(&title, brief, planned),
            planning::strip(&title, views, plan, &tell),
        ];
        for page in pages {
            let svg = page.svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf\""));
            inside(&elements(&svg));
            assert!(tiny_skia::Pixmap::decode_png(&page.png(200)).is_ok());
        }
        let film = planning::animation(&title, views, plan, &tell);
        assert!(!film.contains("NaN") && !film.contains("inf\""));
        elements(&film);
    }
}

/// Nothing is drawn beside the page.
fn inside(list: &[Element]) {
    let size: Vec<f64> = list[0]
        .get("viewBox")
        .split(' ')
        .map(|t| t.parse().unwrap())
        .collect();
    let size = DVec2::new(size[2], size[3]);
    for e in list.iter().filter(|e| e.name == "path") {
        let (lo, hi) = e
            .points()
            .iter()
            .fold((size, DVec2::ZERO), |(l, h), p| (l.min(*p), h.max(*p)));
        assert!(
            lo.min_element() >= 0.0 && (size - hi).min_element() >= 0.0,
            "{} {lo} {hi}",
            e.get("aria-label")
        );
    }
}

#[test]
fn the_same_plan_gives_the_same_bytes() {
    let (a, b) = (mended(), mended());
    assert_eq!(sheet(&a).svg(), sheet(&b).svg());
    assert_eq!(sheet(&a).png(500), sheet(&b).png(500));
    assert_eq!(strip(&a).svg(), strip(&b).svg());
    assert_eq!(trade(&a).svg(), trade(&b).svg());
    assert_eq!(film(&a), film(&b));
}
