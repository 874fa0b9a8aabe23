// Validates the WGSL on standard input with Tint; prints its messages as one line of JSON.
import { readFileSync } from 'node:fs';
import { create } from 'webgpu';

// global, as Dawn ends where nothing refers to it any more
globalThis.gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
// every extension that there is
const device = await adapter.requestDevice({ requiredFeatures: [...adapter.features] });
device.pushErrorScope('validation');
const module = device.createShaderModule({ code: readFileSync(0, 'utf8') });
const info = await module.getCompilationInfo();
const messages = info.messages.map(({ type, message, lineNum: line, linePos: column }) =>
  ({ type, message, line, column }));
const error = await device.popErrorScope();
if (error && !messages.some(({ type }) => type === 'error')) {
  messages.push({ type: 'error', message: error.message, line: 0, column: 0 });
}
process.stdout.write(JSON.stringify(messages) + '\n', () => process.exit(0));
