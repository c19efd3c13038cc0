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
  context.configure({ device, format });

  // Points in a buffer of the device, as a compute shader could have made them.
  const points = new Float32Array(3 * 2000);
  for (let i = 0; i < points.length; i += 3) {
    const [z, angle] = [Math.random() * 2 - 1, Math.random() * 2 * Math.PI];
    const radius = 0.9 * Math.random() ** 0.1 * Math.sqrt(1 - z * z);
    points.set([radius * Math.cos(angle), radius * Math.sin(angle), 0.9 * z], i);
  }
  const { COPY_SRC, COPY_DST, VERTEX } = GPUBufferUsage;
  const usage = COPY_SRC | COPY_DST | VERTEX;
  const buffer = device.createBuffer({ size: points.byteLength, usage });
  device.queue.writeBuffer(buffer, 0, points);

  // The mesh stays on the device, and its buffers are those that are drawn.
  const triangulator = await createTriangulator({ device, backend: 'gpu' });
  const mesh = await triangulator.delaunay3d(buffer, { resident: true });
  note.textContent = `${mesh.hullCount} triangles of the hull, drawn where they were made`;

  const code = `
    struct Corner { @builtin(position) position: vec4f, @location(0) at: vec3f }
    @vertex fn corner(@location(0) at: vec3f) -> Corner {
      return Corner(vec4f(at.xy, 0.5 - 0.5 * at.z, 1), at);
    }
    @fragment fn color(@location(0) at: vec3f) -> @location(0) vec4f {
      let normal = normalize(cross(dpdx(at), dpdy(at)));
      return vec4f(vec3f(0.9, 0.5, 0.25) * (0.25 + 0.75 * abs(dot(normal, vec3f(0.5, 0.5, 0.7)))), 1);
    }`;
  const module = device.createShaderModule({ code });
  const attributes = [{ format: 'float32x3', offset: 0, shaderLocation: 0 }];
  const pipeline = device.createRenderPipeline({
    layout: 'auto',
    vertex: { module, buffers: [{ arrayStride: 12, attributes }] },
    fragment: { module, targets: [{ format }] },
    // Counter-clockwise from outside: the front is all that is seen of a hull.
    primitive: { cullMode: 'back' },
  });
  const encoder = device.createCommandEncoder();
  const view = context.getCurrentTexture().createView();
  const clear = { loadOp: 'clear', storeOp: 'store', clearValue: [0.5, 0.5, 0.5, 1] };
  const pass = encoder.beginRenderPass({ colorAttachments: [{ view, ...clear }] });
  pass.setPipeline(pipeline);
  pass.setVertexBuffer(0, buffer);
  pass.setIndexBuffer(mesh.buffers.hull, 'uint32');
  pass.drawIndexed(3 * mesh.hullCount);
  pass.end();
  device.queue.submit([encoder.finish()]);
}
