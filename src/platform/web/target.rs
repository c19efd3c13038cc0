//! Results that go to memory of JavaScript.

use crate::gpu::readback::Target;

/// Memory outside of that of WebAssembly: the bytes get there with one copy.
impl Target for js_sys::Uint8Array {
    fn bytes(&self) -> u64 {
        self.byte_length().into()
    }

    fn take(&mut self, start: u64, len: u64, piece: &wgpu::BufferView) {
        self.set(&piece.as_uint8array().subarray(0, len as u32), start as u32);
    }
}
