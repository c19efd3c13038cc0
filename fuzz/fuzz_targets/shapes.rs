//! Every reader of shapes, and the triangulation of what they return; the first byte chooses the format.
#![no_main]

use gdel::{Backend, MeshView2, Triangulator, verify2d};
use gdel_io::ShapeFormat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&choice, bytes)) = data.split_first() else { return };
    let format = ShapeFormat::ALL[usize::from(choice) % ShapeFormat::ALL.len()];
    let Ok(shapes) = format.read(bytes) else { return };
    if shapes.points.len() > 1000 {
        return;
    }
    // Segments may cross.
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    if let Ok(found) = triangulator.constrained2d(&shapes.points, &shapes.constraints()) {
        let mut view = MeshView2::from(&found.mesh);
        view.segments = Some(&found.segments);
        assert!(verify2d(&shapes.points, view).is_ok_and(|report| report.passed()));
    }
});
