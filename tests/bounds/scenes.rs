//! Scenes in which the plan's bounds are looked at.

use std::path::{Path, PathBuf};

use sootlight::math::random::philox;

/// A scene: files, none for the built-in flame, and what is set.
pub(super) struct Scene {
    pub(super) files: Vec<PathBuf>,
    pub(super) sets: Vec<String>,
    /// Whether it is seen from nearer and higher than the camera that frames it.
    pub(super) is_near: bool,
}

impl Scene {
    fn new(files: &[PathBuf], sets: &[&str]) -> Self {
        Self {
            files: files.to_vec(),
            sets: sets.iter().map(|set| (*set).to_owned()).collect(),
            is_near: false,
        }
    }

    /// For a person.
    pub(super) fn name(&self) -> String {
        let file = self.files.first().and_then(|file| file.file_stem());
        let file = file.map_or("torch".into(), |name| name.to_string_lossy());
        let near = if self.is_near { ", near" } else { "" };
        format!("{file} [{}]{near}", self.sets.join(", "))
    }
}

/// Scenes of the built-in flame.
pub(super) fn eight() -> Vec<Scene> {
    let sets: [&[&str]; 8] = [
        &[],
        &["soot.radius_nm=5", "air.humidity=0"],
        &["soot.radius_nm=80", "air.humidity=0.95"],
        &["soot.amount=0.01"],
        &["soot.amount=100"],
        &["stage.backdrop=checker"],
        &["fuel.salt=sodium", "fuel.salt_ppm=1e-7"],
        &["fuel.name=methanol", "fuel.salt=copper"],
    ];
    let mut scenes: Vec<Scene> = sets.into_iter().map(|sets| Scene::new(&[], sets)).collect();
    scenes[3].is_near = true;
    scenes
}

/// All scenes, with every file of the shared volumes.
pub(super) fn everything(data: &Path) -> Vec<Scene> {
    let mut scenes = eight();
    let mut files: Vec<Vec<PathBuf>> = Vec::new();
    for folder in [
        "plume",
        "pool",
        "campfire",
        "burst",
        "embergen_cc0",
        "panfire_seq",
    ] {
        let entries = std::fs::read_dir(data.join(folder)).unwrap();
        let mut found: Vec<PathBuf> = entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "vdb"))
            .collect();
        found.sort();
        files.extend(found.into_iter().map(|file| vec![file]));
    }
    let pair = |folder: &str, ending: &str| {
        ["density", "temperature"]
            .map(|field| data.join(folder).join(format!("panfire_{field}.{ending}")))
            .to_vec()
    };
    files.push(pair("dense_ascii", "txt"));
    files.push(pair("sparse_binary", "bin"));
    for (which, files) in (0..).zip(&files) {
        scenes.push(Scene::new(files, &[]));
        let sets = generated(which);
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        scenes.push(Scene {
            is_near: which % 2 == 0,
            ..Scene::new(files, &sets)
        });
    }
    scenes
}

/// Settings by chance, the same for the same number.
fn generated(number: u32) -> Vec<String> {
    let random = philox([number, 0, 0, 0], [6, 0]);
    let share = random.map(|bits| f64::from(bits) / f64::from(u32::MAX));
    let [more, ..] = philox([number, 1, 0, 0], [6, 0]);
    let mut sets = vec![
        format!("soot.radius_nm={:.1}", 5.0 * 16_f64.powf(share[0])),
        format!("soot.amount={:.4}", 1e-2 * 1e4_f64.powf(share[1])),
        format!("air.humidity={:.2}", 0.95 * share[2]),
    ];
    match more % 4 {
        0 => sets.push("stage.backdrop=gradient".to_owned()),
        1 => sets.push("stage.ground=true".to_owned()),
        _ => {}
    }
    sets
}
