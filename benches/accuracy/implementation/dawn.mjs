// Runs a compute pass over records with Dawn and Tint, on the Vulkan adapter that Dawn takes first.
//   node dawn.mjs                                 prints package, adapter and driver
//   node dawn.mjs WGSL INPUT OUTPUT TAKEN GIVEN   runs `evaluate`
// INPUT and OUTPUT are files of 32-bit words; TAKEN and GIVEN are the words of a record and of a
// result; `evaluate` and its bindings are those of dpsm::gpu::entry_point.
import { openSync, readFileSync, writeFileSync } from 'node:fs';
import { create, globals } from 'webgpu';

// global, as Dawn ends where nothing refers to it any more
globalThis.gpu = create(['backend=vulkan']);
const adapter = await gpu.requestAdapter();
if (!adapter) throw new Error('Dawn finds no Vulkan adapter that it accepts');

if (process.argv.length === 2) {
  const url = new URL('node_modules/webgpu/package.json', import.meta.url);
  const { version } = JSON.parse(readFileSync(url, 'utf8'));
  const { vendor, architecture, description } = adapter.info;
  console.log(`Dawn with Tint (npm webgpu ${version}) on ${vendor} ${architecture}, ${description}`);
  process.exit(0); // Dawn keeps node alive
}

const [path, input, output, ...lengths] = process.argv.slice(2);
const [taken, given] = lengths.map(Number);
const code = readFileSync(path, 'utf8');
const workgroup = Number(/@workgroup_size\((\d+)\)/.exec(code)[1]);
const device = await adapter.requestDevice();
const { maxStorageBufferBindingSize, maxComputeWorkgroupsPerDimension } = device.limits;
const filters = ['validation', 'out-of-memory', 'internal'];
for (const filter of filters) device.pushErrorScope(filter);

const module = device.createShaderModule({ code });
for (const { type, lineNum, linePos, message } of (await module.getCompilationInfo()).messages) {
  if (type === 'error') throw new Error(`Tint: ${lineNum}:${linePos}: ${message}`);
}
const compute = { module, entryPoint: 'evaluate' };
const pipeline = await device.createComputePipelineAsync({ layout: 'auto', compute });
const layout = pipeline.getBindGroupLayout(0);

const words = readFileSync(input);
const records = words.length / (4 * taken);
const chunk = Math.floor(maxStorageBufferBindingSize / (4 * Math.max(taken, given)));
const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = globals.GPUBufferUsage;
const file = openSync(output, 'w');
for (let first = 0; first < records; first += chunk) {
  const count = Math.min(chunk, records - first);
  const buffer = (length, usage) => device.createBuffer({ size: 4 * count * length, usage });
  const from = buffer(taken, STORAGE | COPY_DST);
  const to = buffer(given, STORAGE | COPY_SRC);
  const back = buffer(given, MAP_READ | COPY_DST);
  device.queue.writeBuffer(from, 0, words, 4 * first * taken, 4 * count * taken);
  const entries = [from, to].map((buffer, binding) => ({ binding, resource: { buffer } }));
  // two dimensions, as one is limited
  const groups = Math.ceil(count / workgroup);
  const rows = Math.ceil(groups / maxComputeWorkgroupsPerDimension);
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout, entries }));
  pass.dispatchWorkgroups(Math.ceil(groups / rows), rows);
  pass.end();
  encoder.copyBufferToBuffer(to, 0, back, 0, back.size);
  device.queue.submit([encoder.finish()]);
  await back.mapAsync(globals.GPUMapMode.READ);
  writeFileSync(file, new Uint8Array(back.getMappedRange()));
  for (const used of [from, to, back]) used.destroy();
}
for (const filter of filters) {
  const error = await device.popErrorScope();
  if (error) throw new Error(`${filter}: ${error.message}`);
}
process.exit(0);
