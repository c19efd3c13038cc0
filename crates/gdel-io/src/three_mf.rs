//! 3MF, the format of 3D printers (3MF Consortium, Core Specification 1.3).
//!
//! Written here, since a ZIP archive of two constant files and one list need no library.

use crate::{
    archive,
    surface::{MARK, Surface},
};
use std::io::{self, BufWriter, Write};
use zip::CompressionMethod::Deflated;

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Writes 3MF with the coordinates as they are, so in millimetres.
pub(super) fn write_surface<const D: usize>(to: impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    archive::write(to, |archive| {
        archive.file("[Content_Types].xml", Deflated, |to| to.write_all(CONTENT_TYPES.as_bytes()))?;
        archive.file("_rels/.rels", Deflated, |to| to.write_all(RELATIONSHIPS.as_bytes()))?;
        archive.file("3D/3dmodel.model", Deflated, |to| {
            let mut to = BufWriter::new(to);
            write_model(&mut to, surface)?;
            to.flush()
        })
    })
}

fn write_model<const D: usize>(to: &mut impl Write, surface: &Surface<'_, D>) -> io::Result<()> {
    writeln!(to, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(to, r#"<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">"#)?;
    writeln!(to, r#"<metadata name="Application">{MARK}</metadata>"#)?;
    writeln!(to, r#"<resources><object id="1" type="model" name="{}"><mesh><vertices>"#, surface.name)?;
    for [x, y, z] in surface.vertices() {
        writeln!(to, r#"<vertex x="{x:?}" y="{y:?}" z="{z:?}"/>"#)?;
    }
    writeln!(to, "</vertices><triangles>")?;
    for [a, b, c] in surface.triangles() {
        writeln!(to, r#"<triangle v1="{a}" v2="{b}" v3="{c}"/>"#)?;
    }
    writeln!(to, r#"</triangles></mesh></object></resources><build><item objectid="1"/></build></model>"#)
}
