// Serves the page to a headless Chromium, and keeps what it posts.
//   node serve.mjs SAMPLE_DIR OUT_DIR SIDE MAP_SIDE
import { spawn } from 'node:child_process';
import { createServer } from 'node:http';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, normalize } from 'node:path';
import { crc32, deflateSync } from 'node:zlib';

const [sample, out, side, mapSide] = [process.argv[2], process.argv[3], Number(process.argv[4]), Number(process.argv[5])];
const types = { html: 'text/html', js: 'text/javascript', json: 'application/json', glsl: 'text/plain', glb: 'model/gltf-binary' };

// CRC of PNG's chunks, where node's zlib has none.
const table = Array.from({ length: 256 }, (_, n) => { for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1; return n >>> 0; });
const crc = (bytes) => (crc32 ? crc32(bytes) : (bytes.reduce((c, b) => table[(c ^ b) & 255] ^ (c >>> 8), ~0) ^ ~0) >>> 0);
function greyPng(width, height, values) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const whole = Buffer.alloc(body.length + 8);
    whole.writeUInt32BE(data.length, 0);
    body.copy(whole, 4);
    whole.writeUInt32BE(crc(body), body.length + 4);
    return whole;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 0, 0, 0, 0], 8);
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) values.copy(rows, y * (width + 1) + 1, y * width, (y + 1) * width);
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

let finish;
const done = new Promise((resolve) => { finish = resolve; });
const server = createServer((request, response) => {
  const name = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname)).replace(/^[/.]+/, '');
  if (request.method === 'POST') {
    const parts = [];
    request.on('data', (part) => parts.push(part));
    request.on('end', () => {
      const body = Buffer.concat(parts);
      if (name === 'done') finish(JSON.parse(body));
      else if (name.endsWith('.mask')) writeFileSync(join(out, `${name}.png`), greyPng(side, side, body));
      else writeFileSync(join(out, name), body);
      response.end();
    });
    return;
  }
  try {
    let body;
    if (name === 'setup.json') body = JSON.stringify({ side, mapSide, candela: 60 });
    else if (name.startsWith('three/')) body = readFileSync(join(out, 'node_modules', name));
    else if (name === 'scene.glb' || name === 'shadow.glsl') body = readFileSync(join(out, name));
    else body = readFileSync(join(sample, name || 'page.html'));
    response.setHeader('Content-Type', types[(name || 'page.html').split('.').pop()] ?? 'application/octet-stream');
    response.end(body);
  } catch {
    response.statusCode = 404;
    response.end();
  }
});
await new Promise((listening) => server.listen(0, '127.0.0.1', listening));

const profile = mkdtempSync(join(tmpdir(), 'gnomon-web-'));
const browser = spawn('chromium', ['--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', `--user-data-dir=${profile}`, '--no-first-run', '--disable-extensions',
  '--enable-logging=stderr', '--v=0', `http://127.0.0.1:${server.address().port}/page.html`], { stdio: ['ignore', 'ignore', 'pipe'] });
let said = '';
browser.stderr.on('data', (text) => { said += text; });
const late = setTimeout(() => finish({ failed: `the page did not finish in 240 s\n${said.slice(-3000)}` }), 240000);
const told = await done;
clearTimeout(late);
browser.kill('SIGKILL');
await new Promise((gone) => browser.on('close', gone));
server.close();
rmSync(profile, { recursive: true, force: true });
if (told.failed || told.errors.length > 0) {
  console.error(`samples/web: ${told.failed ?? JSON.stringify(told.errors)}\n${said.split('\n').filter((l) => l.includes('CONSOLE')).join('\n')}`);
  process.exit(1);
}
console.log(`three.js r${told.three} on ${told.renderer}, near ${told.near.toPrecision(4)} m, far ${told.far.toPrecision(4)} m`);
