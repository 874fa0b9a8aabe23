// Validates WGSL files with Tint; prints each message and fails where one is an error.
import { readFileSync } from 'node:fs';
import { create } from 'webgpu';

// global, as Dawn ends where nothing refers to it any more
globalThis.gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice();
let errors = 0;
for (const path of process.argv.slice(2)) {
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code: readFileSync(path, 'utf8') });
  const { messages } = await module.getCompilationInfo();
  for (const { type, lineNum, linePos, message } of messages) {
    console.log(`${path}:${lineNum}:${linePos}: ${type}: ${message}`);
    errors += type === 'error';
  }
  if (await device.popErrorScope()) errors += messages.length === 0;
}
console.log(`Tint: ${process.argv.length - 2} files, ${errors} errors`);
process.exit(errors ? 1 : 0);
