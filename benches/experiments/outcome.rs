//! What an experiment has to show: tables and charts.

use crate::charts::Chart;
use serde_json::{Value, json};
use std::{error::Error, fmt, fs, path::Path};

/// The result of an experiment.
#[derive(Default)]
pub struct Outcome {
    pub tables: Vec<Table>,
    pub charts: Vec<Chart>,
}

/// Rows of numbers, texts, and nulls where there is nothing.
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    pub fn new<const N: usize>(columns: [&str; N]) -> Self {
        Table { columns: columns.map(str::to_owned).to_vec(), rows: Vec::new() }
    }

    /// Adds a row, which has an entry for each column.
    pub fn push<const N: usize>(&mut self, row: [Value; N]) {
        assert_eq!(N, self.columns.len());
        // Now, and not when all is done: some experiments take long.
        eprintln!("{}", row.iter().map(text).collect::<Vec<_>>().join("  "));
        self.rows.push(row.to_vec());
    }

    fn json(&self) -> Value {
        let object = |row: &Vec<Value>| self.columns.iter().cloned().zip(row.iter().cloned()).collect();
        Value::Array(self.rows.iter().map(|row| Value::Object(object(row))).collect())
    }
}

/// Returns a number with three digits, or a count with separated thousands.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => match number.as_u64() {
            Some(count) => grouped(count),
            None => {
                let x = number.as_f64().unwrap_or(f64::NAN);
                let decimals = if x.abs() >= 100.0 {
                    0
                } else if x.abs() >= 10.0 {
                    1
                } else if x.abs() >= 1.0 {
                    2
                } else {
                    3
                };
                format!("{x:.decimals$}")
            }
        },
        other => other.to_string(),
    }
}

fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "| {} |", self.columns.join(" | "))?;
        writeln!(f, "|{}", " --- |".repeat(self.columns.len()))?;
        for row in &self.rows {
            writeln!(f, "| {} |", row.iter().map(text).collect::<Vec<_>>().join(" | "))?;
        }
        Ok(())
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.tables.iter().try_for_each(|table| writeln!(f, "{table}"))
    }
}

impl Outcome {
    /// Writes `NAME.json` and an SVG for each chart.
    pub fn write(&self, folder: &Path, name: &str, setting: &str) -> Result<(), Box<dyn Error>> {
        fs::create_dir_all(folder)?;
        let tables: Vec<Value> = self.tables.iter().map(Table::json).collect();
        let path = folder.join(format!("{name}.json"));
        fs::write(&path, serde_json::to_string_pretty(&json!({ "setting": setting, "tables": tables }))? + "\n")?;
        println!("{}", path.display());
        for chart in &self.charts {
            let path = folder.join(format!("{name}-{}.svg", chart.name()));
            chart.write(&path)?;
            println!("{}", path.display());
        }
        println!();
        Ok(())
    }
}
