//! The TypeScript declarations of the statistics are those of the Rust structs.

use gdel::{
    internals::fields::{FieldOfStruct, Struct},
    stats::{ExactCounts, GpuStats, Round, SplayStats, Stats, UpdateStats},
};
use std::{fmt::Write as _, fs, path::Path};

const FILE: &str = "web/src/stats.ts";
const REGENERATE: &str = "WRITE_STATS_TS=1 cargo test --test cpu stats_ts";

#[test]
fn stats_ts_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    let generated = declarations();
    if std::env::var_os("WRITE_STATS_TS").is_some() {
        fs::write(&path, &generated).expect("the file can be written");
    }
    let committed = fs::read_to_string(&path).expect("the file is there").replace("\r\n", "\n");
    assert_eq!(committed, generated, "{FILE} is stale; regenerate it by\n  {REGENERATE}\n");
}

fn declarations() -> String {
    let mut file = format!("// Generated from src/stats.rs by `{REGENERATE}`.\n");
    let structs = [
        Stats::DECLARATION,
        ExactCounts::DECLARATION,
        GpuStats::DECLARATION,
        Round::DECLARATION,
        SplayStats::DECLARATION,
        UpdateStats::DECLARATION,
    ];
    for Struct { name, attributes, fields } in structs {
        file.push('\n');
        // The paragraphs that follow, and the examples, are about Rust.
        let docs = docs(attributes);
        comment(&mut file, "", docs.split("\n\n").next().unwrap_or_default());
        writeln!(file, "export interface {name} {{").unwrap();
        for FieldOfStruct { name, attributes, typescript } in fields {
            if let Some(typescript) = typescript() {
                comment(&mut file, "  ", &self::docs(attributes));
                writeln!(file, "  {}: {typescript};", name()).unwrap();
            }
        }
        file.push_str("}\n");
    }
    file
}

/// Returns the documentation among attributes, without links.
fn docs(attributes: &[&str]) -> String {
    let lines = attributes.iter().filter_map(|attribute| {
        let text = attribute.strip_prefix("doc =")?.trim().trim_start_matches(['r', '#']).trim_end_matches('#');
        text.strip_prefix('"')?.strip_suffix('"').map(str::trim)
    });
    without_links(&lines.collect::<Vec<_>>().join("\n"))
}

/// Turns [`A::b`](C) into `A::b`.
fn without_links(docs: &str) -> String {
    let mut text = String::new();
    let mut rest = docs;
    while let Some(start) = rest.find("[`") {
        let (before, link) = rest.split_at(start);
        let end = link.find("`]").expect("a link ends");
        text.push_str(before);
        text.push_str(&link[1..=end]);
        rest = &link[end + 2..];
        if rest.starts_with('(') {
            rest = &rest[rest.find(')').expect("a target ends") + 1..];
        }
    }
    text + rest
}

/// Writes a comment, wrapped at 100 columns as the formatter leaves it.
fn comment(file: &mut String, indent: &str, text: &str) {
    let words: Vec<_> = text.split_whitespace().collect();
    let line = format!("{indent}/** {} */", words.join(" "));
    if line.chars().count() <= 100 {
        writeln!(file, "{line}").unwrap();
        return;
    }
    writeln!(file, "{indent}/**").unwrap();
    let mut line = format!("{indent} *");
    for word in words {
        if line.chars().count() + 1 + word.chars().count() > 100 {
            writeln!(file, "{line}").unwrap();
            line = format!("{indent} *");
        }
        line = line + " " + word;
    }
    writeln!(file, "{line}\n{indent} */").unwrap();
}
