//! # Sootlight
//!
//! Fire as physics makes it: soot that glows by Planck's law, absorbs and is carried per wavelength to an
//! adapting eye. The library is the whole program; the binary only calls [`cli::run`].
//!
//! ## The house
//!
//! A floor has rooms; imports point strictly down, rooms on one floor are strangers to each other.
//!
//! ```text
//! 11 main.rs      run, print the error chain, exit code
//! 10 cli          flags → validated command: window | render | study | info | spectrum
//!  9 app          the window (feature `window`)
//!  8 range        frames of a sequence, or views around one fire, as pictures: what is measured once and held, what is
//!                 written, what is kept
//!  7 engine       background rendering for the window: submit(Job), drain() → tiles
//!    study        accuracy against time: variants, reference, the front; which numbers are good enough
//!    export       a still's whole road to its file: PNG, EXR; provenance comes in as text; nothing half-written
//!    sequence     numbered files on disk ↔ frame numbers
//!  6 project      all that a person can set: the scene file, --set, presets
//!  5 render       THE CORE: plan and tables; fields of scattered, thrown and bent light; ways, kernel and march; film,
//!                 passes, develop; parts that stand for a picture; the unbiased reference; what effects cost. Headless,
//!                 no global state, and no clock but to tell what work took and when to hand on what is there of it
//!  4 scene        Flame (volume + fuel + salt + air), what its gas does beside soot and how it bends light, how finely and
//!                 in which means each brick is looked at, Camera,
//!                 Stage, wavelength sets
//!  3 volume       grids in memory and on disk, which of them a field is made from and how, the built-in flames
//!  2 physics      laws: f64, SI, no grids, no pictures
//!    colour       the standard observer, adaptation, display
//!  1 spectral     wavelengths with weights
//!    math         rays, boxes, lanes, random numbers
//! ```
//!
//! `tests/architecture.rs` holds the code to this picture.
//!
//! ## Words
//!
//! * **radiance** L, spectral: W m⁻² sr⁻¹ nm⁻¹. Wavelengths are vacuum wavelengths in nm.
//! * **soot volume fraction** f_v: volume of soot per volume of gas, dimensionless, 1e-8 to 1e-5.
//! * **absorption coefficient** σ_a, **emission coefficient** j = σ_a B(λ, T), and more where
//!   radicals glow; **optical depth** τ = ∫ σ ds.
//! * **XYZ**: Σ L x̄ Δλ with the CIE 1931 2° observer, W m⁻² sr⁻¹; luminance is 683 Y cd m⁻².
//! * **medium**: the volume's fields mapped to physical units and packed for the march.
//! * **plan**: which effects are computed for a scene, and why; **fields**: what they need before a ray is marched.
//! * **scattering coefficient** σ_s, **extinction** σ_t = σ_a + σ_s; **asymmetry** g: mean cosine of the scattering.
//! * **refractivity** n − 1, of which only the difference to that of the air around bends light.
//! * **stage**: matt surfaces that the fire lights; **backdrop**: a shining screen behind everything.
//! * **feature**: a line, a band or a part of the radicals' light, carried at a wavelength of its own.
//! * **film**: the only place where a spectrum becomes three numbers.
//! * **error** of a picture: the 95th percentile of ΔE_ITP over lit pixels, against the study's reference.
//! * **frame** of a sequence: the files of one number. What would differ from frame to frame, such as the mapping of a field
//!   by the file's own peak, is **held**: set as keys of the scene file.
//! * **flaw**: what could not be faithful, carried with the frame and told to the person.

#[cfg(feature = "window")]
pub mod app;
pub mod cli;
pub mod colour;
pub mod engine;
pub mod export;
pub mod math;
pub mod physics;
pub mod project;
pub mod range;
pub mod render;
pub mod scene;
pub mod sequence;
pub mod spectral;
pub mod study;
pub mod volume;
