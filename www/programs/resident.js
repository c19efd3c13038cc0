import { createTriangulator } from 'gdel-wasm';

const adapter = await navigator.gpu?.requestAdapter();
if (adapter) await show(await adapter.requestDevice());
else document.body.textContent = 'This browser offers no WebGPU, which this example needs.';

async function show(device) {
  document.body.innerHTML =
    '<p></p><canvas width=600 height=600 style="max-width: 500px"></canvas>';
  const [note, canvas] = document.body.children;
  const context = canvas.getContext('webgpu');
  const format = navigator.gpu.getPreferredCanvasFormat();
  context.configure({ device, format, alphaMode: 'premultiplied' });

  // Points in a buffer of the device, as a compute shader could have made them.
  const count = 1000;
  const points = new Float32Array(2 * count);
  for (let i = 0; i < count; i++) {
    const [r, angle] = [0.98 * Math.sqrt(Math.random()), 2 * Math.PI * Math.random()];
    points.set([r * Math.cos(angle), r * Math.sin(angle)], 2 * i);
  }
  const { COPY_SRC, COPY_DST, VERTEX } = GPUBufferUsage;
  const usage = COPY_SRC | COPY_DST | VERTEX;
  const buffer = device.createBuffer({ size: points.byteLength, usage });
  device.queue.writeBuffer(buffer, 0, points);

  // The mesh stays on the device, and its buffers are those that are drawn.
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const mesh = await triangulator.delaunay2d(buffer, { resident: true });
  note.textContent = `${mesh.triangleCount} triangles, drawn where they were made`;

  const code = `
    struct Corner { @builtin(position) position: vec4f, @location(0) @interpolate(flat) color: vec4f }
    @vertex fn corner(@location(0) at: vec2f, @builtin(vertex_index) i: u32) -> Corner {
      let warm = 0.5 + 0.3 * at.x + 0.2 * sin(f32(i));
      return Corner(vec4f(at, 0, 1), vec4f(warm, 0.5, 1 - warm, 1));
    }
    @fragment fn paint(corner: Corner) -> @location(0) vec4f { return corner.color; }`;
  const module = device.createShaderModule({ code });
  const attributes = [{ format: 'float32x2', offset: 0, shaderLocation: 0 }];
  const pipeline = device.createRenderPipeline({
    layout: 'auto',
    vertex: { module, buffers: [{ arrayStride: 8, attributes }] },
    fragment: { module, targets: [{ format }] },
  });
  const encoder = device.createCommandEncoder();
  const view = context.getCurrentTexture().createView();
  const attachment = { view, loadOp: 'clear', storeOp: 'store' };
  const pass = encoder.beginRenderPass({ colorAttachments: [attachment] });
  pass.setPipeline(pipeline);
  pass.setVertexBuffer(0, buffer);
  pass.setIndexBuffer(mesh.buffers.triangles, 'uint32');
  pass.drawIndexed(3 * mesh.triangleCount);
  pass.end();
  device.queue.submit([encoder.finish()]);
}
