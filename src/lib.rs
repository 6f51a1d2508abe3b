//! `pillarforest`: scenes of models, eyes and pillars (or other supports: plates, stairs, any mesh) become printable forests in
//! which each model appears, complete and correctly shaded, from one eye only.
//!
//! The method is *Appearance-Mimicking Surfaces* (Schueller, Panozzo & Sorkine-Hornung, SIGGRAPH Asia 2014): every vertex of a
//! model moves only along its ray from the eye, so that normals are kept while hard depth bounds hold; every disconnected piece
//! has a scale of its own; the surface is then cut and each piece scaled back onto its support.
//!
//! # Stages
//!
//! Each stage is a function from one named type to the next; [`compile::run`] is all of them on one screen.
//!
//! | from | by | to |
//! |---|---|---|
//! | scene text and model files | [`scene::resolve`] | [`scene::Scene`]: millimetres, everything loaded, placed and checked |
//! | scene whose pillars are to be found | [`compile::planned`] | the same with pillars, and what they are worth |
//! | an eye in plan and outlines of pillars | [`horizon::Horizon::new`] | [`horizon::Horizon`]: which is met first at every bearing; the planner, and plans that are drawn, see through it |
//! | supports | [`viewmap::SupportField::new`] | supports ready for rays |
//! | a view's models | [`viewmap::Target::new`] | the target ready for rays, projected |
//! | target and supports | [`viewmap::view_map`] | [`viewmap::ViewMap`]: which face and which support the eye sees, as cells of its image |
//! | view map | [`groups::groups`] | [`groups::Groups`]: depth groups and bounds |
//! | groups of all views | [`contest::settle`] | [`contest::Settlement`]: contested surface, and which view loses it |
//! | groups | [`mimic::depths`] | [`mimic::Depths`]: relative depth of every vertex, scale of every group |
//! | or groups | [`steps::torn`] | [`steps::Torn`]: the same for the surface cut along tears, with its target, map and groups |
//! | groups of a mesh that stays whole | [`whole::whole`] | the same as one group, hidden parts held too; afterwards [`whole::moved`], the closed mesh, and its [`whole::Crossings`] |
//! | depths | [`surface::surface`] | [`surface::Surface`]: the optimised surface with the input's attributes, for other programs |
//! | depths | [`relief::relief`] | [`relief::Relief`]: depth of every cell's corners, cut and scaled back |
//! | depths and relief | [`diagram::section::section`] | [`diagram::section::Section`]: groups cut open through the eye, their bounds, scales and pieces |
//! | reliefs of all views | [`carve::carve`], [`carve::joined`] for whole meshes | [`carve::Forest`]: checked solids |
//! | standing supports | [`split::split`] | [`split::Split`]: plates and pillars to be put together |
//! | views and what is wanted of a layout | [`planner::plan`], [`planner::repair`] | [`planner::Planned`], or [`planner::NoLayout`]: what binds |
//! | forest, reliefs and views | [`certify`] | certificates: coverage, conflicts, layers and order, eye tolerance, camouflage, printability |
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
//! # Invariants
//!
//! - A module names only modules that stand above it in the list below.
//! - Nothing here touches files, the clock or the terminal: the binary (`main.rs`, `cli/`) does.
//! - The same scene gives the same bytes, whatever the thread count: no hash order, fixed orders of reduction, random numbers only in
//!   [`planner`], from the scene's seed.
//! - Printable formats take [`mesh::Solid`], whose only constructor checks closed, oriented, 2-manifold, free of
//!   self-intersection and positive volume after rounding to f32.
//! - One library, one module: `alum` in [`mesh::simplify`], `obvhs` in [`bvh`], `spade` in `viewmap::arrange`, `clarabel` in
//!   `mimic::solve`, `faer` in `mimic::dual::factor`, `manifold-rust` in `carve::boolean`, `i_overlay` in `carve::hollow`, `exmex` in
//!   `scene::heights`, `rand` in [`planner`].
//! - Supports are a [`support::SupportKind`] with a mesh and, as seen from an eye, a [`support::Slab`] of allowed depths. All that are no
//!   pillars are one kind, a body: a new form is a new mesh in `scene::forms`, not a new pipeline.
#![forbid(unsafe_code)]

// In reading order; blank lines keep the formatter from sorting them.

pub mod diag;

pub mod index;

pub mod geom;

pub mod horizon;

pub mod mesh;

pub mod bvh;

pub mod support;

pub mod view;

pub mod viewmap;

pub mod groups;

pub mod contest;

pub mod laplacian;

pub mod mimic;

pub mod steps;

pub mod whole;

pub mod surface;

pub mod relief;

pub mod carve;

pub mod split;

pub mod planner;

pub mod formats;

pub mod diagram;

pub mod render;

pub mod certify;

pub mod words;

pub mod report;

pub mod scene;

pub mod compile;

pub mod figures;
