//! A folder with a flame to run the program in.

use std::fmt::Write as _;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// A folder with a small flame in two dense ASCII files.
pub(super) struct Place {
    folder: TempDir,
}

impl Place {
    pub(super) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [width, height, depth] = [8, 8, 12];
        let mut files = [
            ("density.txt", String::new()),
            ("temperature.txt", String::new()),
        ];
        for (_, text) in &mut files {
            writeln!(text, "{width} {height} {depth}").unwrap();
        }
        for i in 0..width * height * depth {
            let along = |x: i32, n: i32| f64::from(2 * x + 1 - n) / f64::from(n);
            let (x, y, z) = (i % width, i / width % height, i / (width * height));
            let inside =
                1.0 - along(x, width).powi(2) - along(y, height).powi(2) - along(z, depth).powi(2);
            let inside = inside.max(0.0);
            writeln!(files[0].1, "{}", 5e-6 * inside).unwrap();
            writeln!(files[1].1, "{}", 300.0 + 1600.0 * inside).unwrap();
        }
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        Self { folder }
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(super) fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub(super) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs the program in the folder, with words separated by spaces.
    pub(super) fn run(&self, words: &str) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sootlight"));
        command
            .args(words.split_whitespace())
            .current_dir(self.folder.path());
        command
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET");
        command.output().unwrap()
    }

    /// Runs it and holds it to an exit code; gives standard output and standard error.
    #[track_caller]
    pub(super) fn expect(&self, code: i32, words: &str) -> [String; 2] {
        let output = self.run(words);
        let streams = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!(
            output.status.code(),
            Some(code),
            "sootlight {words}\n{}{}",
            streams[0],
            streams[1]
        );
        streams
    }
}

/// Pixels, info and the text under a keyword of a PNG.
pub(super) fn read_png(
    path: &Path,
) -> (Vec<u8>, png::Info<'static>, impl Fn(&str) -> String + use<>) {
    let mut reader = png::Decoder::new(Cursor::new(std::fs::read(path).unwrap()))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let info = reader.info().clone();
    let chunks = info.utf8_text.clone();
    let text = move |keyword: &str| {
        let chunk = chunks
            .iter()
            .find(|chunk| chunk.keyword == keyword)
            .unwrap();
        chunk.get_text().unwrap()
    };
    (pixels, info, text)
}
