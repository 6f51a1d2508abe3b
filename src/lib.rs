//! `pillarforest`: scenes of models, eyes and pillars (or other supports: plates, stairs, any mesh) become printable forests in
//! which each model appears, complete and correctly shaded, from one eye only.
//!
//! The method is *Appearance-Mimicking Surfaces* (Schueller, Panozzo & Sorkine-Hornung, SIGGRAPH Asia 2014): every vertex of a
//! model moves only along its ray from the eye, so that normals are kept while hard depth bounds hold; every disconnected piece
//! has a scale of its own; the surface is then cut and each piece scaled back onto its support.
//!
//! # Stages
//!
//! Each stage is a function from one named type to the next; [`compile`] is all of them on one screen, goal by goal.
//!
//! | from | by | to |
//! |---|---|---|
//! | a model's file | [`intake::load_original`] | [`intake::Admitted`]: a mesh fit to be looked at, and what its file says besides |
//! | scene text and model files | [`scene::resolve`] | [`scene::Scene`]: millimetres, everything loaded, placed and checked |
//! | scene | [`compile::slow`] | a note on how long its build will take, if that is long |
//! | scene whose pillars are to be found | [`compile::planned`] | the same with pillars, and what they are worth |
//! | an eye in plan and outlines of pillars | [`horizon::Horizon::new`] | [`horizon::Horizon`]: which is met first at every bearing; the planner, and plans that are drawn, see through it |
//! | supports | [`viewmap::SupportField::new`] | supports ready for rays |
//! | a view, supports | [`viewmap::Image::new`] | its models projected, and the map of what it sees: which face and which support, as cells of its image |
//! | image | [`groups::groups`] | [`groups::Groups`]: depth groups and bounds |
//! | a view, supports | [`sight::Sight::new`] | both as one value, which all stages below take |
//! | sight | [`kinds::ReliefKind::held`] | the same with what its kind of relief holds |
//! | sights of all views | [`contest::settle`] | [`contest::Settlement`]: contested surface, and which view loses it |
//! | sight | [`mimic::depths`] | [`mimic::Depths`]: relative depth of every vertex, scale of every group |
//! | or sight | [`steps::torn`] | [`steps::Torn`]: the same for the surface cut along tears, with a sight of its own |
//! | depths | [`surface::surface`] | [`surface::Surface`]: the optimised surface with the input's attributes, for other programs |
//! | depths | [`relief::relief`] | [`relief::Relief`]: depth of every cell's corners, cut and scaled back |
//! | depths and relief | [`diagram::section::section`] | [`diagram::section::Section`]: groups cut open through the eye, their bounds, scales and pieces |
//! | sight | [`kinds::ReliefKind::optimised`] | [`kinds::Optimised`]: the last four in the way of its kind of relief, and their certificate |
//! | what all views put on supports | [`carve::carve`] | [`carve::Forest`]: checked solids |
//! | standing supports | [`split::split`] | [`split::Split`]: plates and pillars to be put together |
//! | views and what is wanted of a layout | [`planner::plan`], [`planner::repair`] | [`planner::Planned`], or [`planner::NoLayout`]: what binds |
//! | forest, reliefs and views | [`certify`] | certificates: coverage, conflicts, layers and order, eye tolerance, camouflage, printability |
//! | a mesh file's bytes | [`intake::load_original`], [`intake::inspect()`] | a model fit to be worked with, with all that its file says; or what is wrong with it for printing |
//! | a model | [`render::six_sides()`] | its six sides, for whoever does not know which of them is the front |
//! | what stages found | [`words`] | [`diag::Diagnostic`]s for people |
//! | forest and views | [`render::view_pictures`], [`render::light_pictures`], [`render::turntable()`], [`diagram::plan`], [`formats`], [`report`] | bytes of files |
//! | scenes after the paper's figures | [`figures::make`] | [`figures::Done`]: measurements and claims beside what the paper says |
//!
//! # Symbols
//!
//! `o` eye; `q` a ray as a point of the image plane; `z` depth along the plane's forward axis; `lambda` distance along the ray,
//! `lambda0` that of the model; `s = lambda / lambda0 = z / z0` relative depth; `x = ln s`; `mu_g` scale of group `g`,
//! `m_g = ln mu_g`; `w` vertex weight. Millimetres, radians and f64 unless a name says otherwise; z is up. An eye at infinity is
//! one [`geom::FAR_MM`] away whose image is measured as from [`geom::READING_MM`]: only tolerances in log depth know the difference.
//!
//! # Glossary
//!
//! Words of this project. Those of the field (BVH, quadratic program, winding number) mean what they mean elsewhere.
//!
//! | word | means |
//! |---|---|
//! | view | an eye with the models it is to see |
//! | support | a solid that carries reliefs: a pillar, or a body of any other form; the base carries none |
//! | layer | the room a relief may fill on a support; its *datum* is what it is measured from, its *slab* how one eye meets it |
//! | core | material that must be left of a support behind a layer |
//! | target | the models of a view as one mesh, projected |
//! | view map | the image of an eye, triangulated into *cells*, each of one model face on one support |
//! | facet | a face of the supports' mesh, in contrast to one of the model |
//! | group | a connected part of the image on one support, as far as its layer goes on without a jump, with a scale `mu` of its own |
//! | object | what of a model hangs together, cuts or touches itself: it has one outline |
//! | anchor | a point of a face as a mix of its vertices |
//! | bound | how near and how far an anchor may lie, before `mu` is applied |
//! | drawn | of a bound or outline: made to lie on the support itself |
//! | order | of two sheets on one ray: which of them is nearer |
//! | free | a vertex without bounds |
//! | sight | all that is known of a view before its depths are found |
//! | contest | surface that two views want |
//! | kind of relief | height field, torn, or whole |
//! | whole | a closed mesh that is deformed and built as it is, in contrast to what is cut |
//! | step, tear | a jump of depth along rays, and the line where the surface is torn for it |
//! | patch | the part of one face seen on one group; tears run between patches |
//! | relief | the optimised surface cut and scaled back onto its supports |
//! | block | a relief as a solid, with its backing |
//! | hollow | what is carved out of a support before a relief |
//! | fin | what of a support would be left standing beside a hollow in less than a printed line |
//! | bed, lap | how far a relief is sunk in its support's edge, and goes on behind a nearer support |
//! | brace | a tie between a part that would float and its support |
//! | spare | of a corner: the surface is the same without it, within a tolerance |
//! | bare | a support without its reliefs |
//! | ladder, rung | ways to do a thing that are tried in turn, and the one that held |
//! | brief | what the planner is to find |
//! | horizon | which pillar an eye meets first at every bearing, in plan; its *runs* are stretches with one answer |
//! | tolerance | how far an eye may move before steps open |
//! | camouflage | how little of a model is left from elsewhere |
//!
//! # Where to begin
//!
//! | to add | open |
//! |---|---|
//! | a form of support | a file in `scene::supports::bodies` (its fields and its mesh), its fields in `scene::language` |
//! | an energy | [`mimic::Energy`], a file in `mimic` with its `depths`, one line in `mimic::minimise`; its options in `scene::options` |
//! | a kind of relief | a file in [`kinds`] with what differs from [`kinds::Optimised`], its line in [`kinds::ReliefKind`] |
//! | a check of what is built | a file in [`certify`] that gives figures and places, its sentence in [`words`], its line in `compile::certificates` or `compile::print` |
//! | a file format to read | a `read_*` file in [`formats`] and its line in `formats::read`; to write: a file in [`formats`] and its line in `compile::files` |
//! | an input that breaks something, or another thing that is read, for the fuzz targets | `tests/corpus/README.md` |
//!
//! # Invariants
//!
//! - A module names only modules that stand above it in the list below.
//! - Nothing here touches files, the clock or the terminal: the binary (`main.rs`, `cli/`) does.
//! - The same scene gives the same bytes, whatever the thread count: no hash order, fixed orders of reduction, random numbers only in
//!   [`planner`], from the scene's seed.
//! - Printable formats take [`mesh::Solid`]. Its constructors check closed, oriented, 2-manifold, free of self-intersection and positive
//!   volume after rounding to f32; only of what [`mesh::resolved`] just left without intersections they do not look for any again.
//! - One library, one module: `alum` in [`mesh::simplify`], `obvhs` in [`bvh`], `spade` in `viewmap::arrange`, `clarabel` in
//!   `mimic::solve`, `faer` in `mimic::factor`, `manifold-rust` in `carve::boolean`, `i_overlay` in [`geom::rings`], `exmex` in
//!   `scene::supports::bodies::heights`, `png` in `scene::supports::bodies::image`, `rand` in [`planner`].
//! - Geometry does not speak to users: stages return typed findings, and [`words`] turns them into messages. Files and scene texts are
//!   read by those who know their lines and columns, and word what is wrong there.
//! - Supports are a [`support::SupportKind`] with a mesh and, as seen from an eye, a [`support::Slab`] of allowed depths. All that
//!   are no pillars are one kind, a body: a new form is a new mesh in `scene::supports::bodies`, not a new pipeline.
#![forbid(unsafe_code)]

// In reading order; blank lines keep the formatter from sorting them.

pub mod diag;

pub mod index;

pub mod ladder;

pub mod geom;

pub mod horizon;

pub mod mesh;

pub mod bvh;

pub mod support;

pub mod view;

pub mod viewmap;

pub mod groups;

pub mod sight;

pub mod contest;

pub mod laplacian;

pub mod mimic;

pub mod steps;

pub mod surface;

pub mod relief;

pub mod carve;

pub mod split;

pub mod planner;

pub mod formats;

pub mod diagram;

pub mod render;

pub mod certify;

pub mod kinds;

pub mod words;

pub mod intake;

pub mod report;

pub mod scene;

pub mod compile;

pub mod figures;
