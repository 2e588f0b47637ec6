//! `sootlight spectrum`: a table of optics that a script or a spreadsheet reads.

use super::place::Place;

/// The rows under the header, and the comment lines.
fn read(text: &str) -> (Vec<[f64; 5]>, Vec<&str>) {
    let comments: Vec<&str> = text
        .lines()
        .take_while(|line| line.starts_with('#'))
        .collect();
    let mut lines = text.lines().skip(comments.len());
    assert_eq!(
        lines.next(),
        Some("lambda_nm,emission_W_m-3_sr-1_nm-1,absorption_m-1,scattering_m-1,n_minus_1")
    );
    let rows = lines.map(|line| {
        let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        <[f64; 5]>::try_from(numbers).unwrap()
    });
    (rows.collect(), comments)
}

fn at(rows: &[[f64; 5]], lambda_nm: f64) -> [f64; 5] {
    *rows.iter().find(|row| row[0] == lambda_nm).unwrap()
}

#[test]
fn the_usual_place_is_tabulated_with_what_was_assumed() {
    let place = Place::new();
    let [said, errors] = place.expect(0, "spectrum -o a.csv");
    assert!(
        said.contains("a.csv: 401 wavelengths") && errors.is_empty(),
        "{said}{errors}"
    );
    let text = place.text("a.csv");
    let (rows, comments) = read(&text);
    assert_eq!((rows.len(), rows[0][0], rows[400][0]), (401, 380.0, 780.0));
    for expected in [
        "propane",
        "1e-6 (assumed)",
        "1800 K (assumed)",
        "300 K",
        "humidity 0.5",
    ] {
        assert!(
            comments.iter().any(|line| line.contains(expected)),
            "{expected}: {comments:?}"
        );
    }

    // σ_a = 6π E f_v/λ with Chang's E(m) of 0.2382 at 550 nm; B(550 nm, 1800 K) by Wien's law.
    let [_, emission, absorption, scattering, n_minus_1] = at(&rows, 550.0);
    let planck = 1.191042972e20 / 550.0_f64.powi(5) * (-1.438776877e7_f64 / (550.0 * 1800.0)).exp();
    assert!(
        (emission / absorption / planck - 1.0).abs() < 1e-3,
        "{emission} {absorption}"
    );
    assert!((absorption / 8.164 - 1.0).abs() < 1e-3, "{absorption}");
    assert!(
        (2e-3..2e-2).contains(&(scattering / absorption)),
        "{scattering}"
    );
    // Hot products: a sixth of the air's 2.7e-4, and a little more for CO2.
    assert!((n_minus_1 / 4.6e-5 - 1.0).abs() < 0.02, "{n_minus_1}");
    assert!(rows.is_sorted_by(|a, b| a[2] > b[2] && a[3] > b[3] && a[4] > b[4]));
    // Where nothing burns, soot alone glows, ever more towards the red.
    let [said, _] = place.expect(0, "spectrum --flame 0");
    assert!(read(&said).0.is_sorted_by(|a, b| a[1] < b[1]));
}

#[test]
fn a_salt_stands_in_the_table_with_its_area_and_the_burning_gas_with_its_bands() {
    let place = Place::new();
    let rows = |words: &str| {
        let [said, _] = place.expect(0, &format!("spectrum --temperature 2000 {words}"));
        read(&said).0
    };
    let salt = "--set fuel.salt=sodium --set fuel.salt_ppm=1 --flame 0";
    let added = |step: &str| -> f64 {
        let (plain, salted) = (
            rows(&format!("--flame 0 {step}")),
            rows(&format!("{salt} {step}")),
        );
        let width = plain[1][0] - plain[0][0];
        let pairs = plain.iter().zip(&salted);
        pairs
            .map(|(plain, salted)| width * (salted[1] - plain[1]))
            .sum()
    };
    let [fine, coarse] = ["--step 0.5", "--step 5"].map(added);
    assert!(
        fine > 0.0 && (coarse / fine - 1.0).abs() < 1e-6,
        "{fine} {coarse}"
    );

    // Case 33: potassium's red lines lie beyond 700 nm, and it is said.
    let potassium = "spectrum --set fuel.salt=potassium --range 400-700";
    let [said, _] = place.expect(0, potassium);
    let (_, comments) = read(&said);
    let told = comments.iter().find(|line| line.contains("outside"));
    assert!(
        told.is_some_and(|line| line.contains("766.70, 770.11 nm")),
        "{told:?}"
    );
    let [said, _] = place.expect(0, "spectrum --set fuel.salt=potassium --range 400-800");
    assert!(!read(&said).1.iter().any(|line| line.contains("outside")));

    // The Swan band's head at 516.5 nm and the violet of CH stand out of soot of a millionth of the usual amount.
    let blue = rows("--soot 1e-12 --flame 1");
    let emission = |nm: f64| at(&blue, nm)[1];
    assert!(emission(515.0) > 3.0 * emission(519.0));
    assert!(emission(431.0) > 5.0 * emission(445.0));
}

#[test]
fn without_a_file_name_the_table_is_the_answer() {
    let place = Place::new();
    let before = place.names();
    let [plain, errors] = place.expect(0, "spectrum --step 50");
    let [dash, _] = place.expect(0, "spectrum --step 50 -o -");
    assert_eq!((errors.as_str(), read(&plain).0.len()), ("", 9));
    assert_eq!(plain, dash);
    assert_eq!(place.names(), before);
}

#[test]
fn a_place_is_that_of_the_flags_or_the_hottest_of_the_file() {
    let place = Place::new();
    let table = |words: &str| {
        let [said, _] = place.expect(0, &format!("spectrum --range 500-600 --step 50 {words}"));
        let (rows, comments) = read(&said);
        (rows, comments.join("\n"))
    };
    let (usual, _) = table("");
    let (twice, _) = table("--soot 2e-6");
    let (amount, _) = table("--set soot.amount=2");
    assert!((twice[1][2] / usual[1][2] - 2.0).abs() < 1e-12);
    assert_eq!(twice, amount);
    let (hotter, _) = table("--temperature 2000");
    assert_eq!(hotter[1][2], usual[1][2]);
    assert!(hotter[1][1] > 4.0 * usual[1][1] && hotter[1][4] < usual[1][4]);

    // The file's peaks: 5e-6 and 1900 K, less what an even number of voxels leaves at the middle.
    let (_, said) = table("density.txt temperature.txt");
    assert!(
        said.contains("the hottest of density.txt + temperature.txt"),
        "{said}"
    );
    let peak = said
        .split("soot volume fraction: ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .unwrap();
    assert!((4.5e-6..5e-6).contains(&peak.parse().unwrap()), "{peak}");
    let (_, said) = table("density.txt temperature.txt --temperature 1234 --soot 1e-7");
    assert!(
        said.contains("temperature: 1234 K;") && said.contains("1e-7;"),
        "{said}"
    );
}

#[test]
fn fuel_and_air_change_what_they_should() {
    let place = Place::new();
    let one = |words: &str| {
        let [said, _] = place.expect(0, &format!("spectrum --range 550-550 {words}"));
        read(&said).0[0]
    };
    // How much soot there is was said by hand: only its kind is the fuel's.
    let model = "--set soot.model=dalzell-sarofim --set volume.soot.scale=1";
    let [propane, acetylene] =
        ["propane", "acetylene"].map(|fuel| one(&format!("{model} --set fuel.name={fuel}")));
    // E(m) of propane's soot over acetylene's at 550 nm; k_comp 1.056 against 1.091, of which gas of 1800 K holds 76 %
    // and, because acetylene's flame is hotter, 67 %: 1.0426 against 1.0610.
    assert!(propane[2] > 1.1 * acetylene[2], "{propane:?} {acetylene:?}");
    let bent = acetylene[4] / propane[4];
    assert!((bent / 1.0176 - 1.0).abs() < 1.5e-3, "{bent}");

    let air = |words: &str| one(&format!("--temperature 300 {words}"))[4];
    let [dry, moist] = ["0", "1"].map(|h| air(&format!("--set air.humidity={h}")));
    assert!(
        moist < dry && (1.0 - moist / dry - 5e-3).abs() < 1e-3,
        "{dry} {moist}"
    );
    assert!(air("--set air.co2_ppm=2000") > air("--set air.co2_ppm=0"));
}

#[test]
fn what_makes_no_sense_is_usage_and_leaves_nothing() {
    let place = Place::new();
    let before = place.names();
    for (words, expected) in [
        ("spectrum --range 780-380", "it must rise"),
        ("spectrum --range 200-380", "from 230 nm on"),
        ("spectrum --range 380", "such as 380-780"),
        ("spectrum --step 0", "the step is 0 nm"),
        ("spectrum --step 0.001 --range 300-3000", "longer step"),
        ("spectrum --temperature 0", "between 1 and 100000"),
        ("spectrum --temperature nan", "between 1 and 100000"),
        ("spectrum --temperature hot", "hot"),
        ("spectrum --soot 2", "--soot 2: it must lie between 0 and 1"),
        (
            "spectrum --flame -0.5",
            "--flame -0.5: it must lie between 0 and 1",
        ),
        ("spectrum -o a.png", ".csv"),
        (
            "spectrum density.txt -o density.txt",
            "the volume is the same file",
        ),
        ("spectrum --set fuel.nam=propane", "did you mean fuel.name?"),
        (
            "spectrum --set air.temperature_k=400 --set air.humidity=1",
            "lower the humidity",
        ),
        ("spectrm", "did you mean spectrum?"),
    ] {
        let [said, error] = place.expect(2, words);
        assert!(
            error.contains(expected) && said.is_empty(),
            "sootlight {words}\n{said}{error}"
        );
    }
    let [_, error] = place.expect(1, "spectrum -o missing/a.csv");
    assert!(error.contains("folder does not exist"), "{error}");
    let [_, error] = place.expect(1, "spectrum no-such.vdb -o a.csv");
    assert!(error.contains("no-such.vdb"), "{error}");
    assert_eq!(place.names(), before);
}
