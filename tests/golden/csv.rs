//! Reads the reference CSV files: `#` comments, one header line, comma-separated, text with commas in quotes.
//!
//! Test code. `physics` and `colour` are strangers to each other, so each includes this file by its path.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a reference file that does not read must fail its test"
)]

/// A parsed reference file.
pub(crate) struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// One line of a [`Table`], asked by column name.
pub(crate) struct Row<'a> {
    header: &'a [String],
    fields: &'a [String],
}

impl Table {
    /// Splits the text; every line must have as many fields as the header.
    pub(crate) fn parse(text: &str) -> Self {
        let mut lines = text
            .lines()
            .filter(|line| !line.starts_with('#') && !line.is_empty())
            .map(split);
        let header = lines.next().expect("a header line");
        let rows: Vec<_> = lines.collect();
        assert!(!rows.is_empty(), "a reference file with rows");
        for row in &rows {
            assert_eq!(row.len(), header.len(), "ragged line: {row:?}");
        }
        Self { header, rows }
    }

    /// All lines after the header.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|fields| Row {
            header: &self.header,
            fields,
        })
    }
}

impl Row<'_> {
    /// The field of a named column.
    pub(crate) fn text(&self, column: &str) -> &str {
        let index = self.header.iter().position(|name| name == column);
        &self.fields[index.unwrap_or_else(|| panic!("no column {column:?}"))]
    }

    /// The field of a named column as a number; exponents beyond f64 read as 0.
    pub(crate) fn number(&self, column: &str) -> f64 {
        let text = self.text(column);
        text.parse()
            .unwrap_or_else(|_| panic!("{column}: {text:?} is no number"))
    }
}

/// Splits at commas outside double quotes, and drops the quotes.
fn split(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for character in line.chars() {
        match character {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            other => fields.last_mut().expect("at least one field").push(other),
        }
    }
    fields
}
