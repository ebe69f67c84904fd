// WebAssembly computes the same bits as the native engine: runs the cases of crates/qhat-scene/tests/golden.txt through
// the package that `scripts/build-wasm --node` builds, and compares the hashes. `node --test
// crates/qhat-wasm/tests/golden.mjs`

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { test } from 'node:test';

const qhat = createRequire(import.meta.url)('../../../target/wasm-node/qhat_wasm.js');
const cases = readFileSync(new URL('../../qhat-scene/tests/golden.txt', import.meta.url), 'utf8')
  .split('\n')
  .filter((line) => line !== '' && !line.startsWith('#'))
  .map((line) => line.split(/\s+/));
const saved = readFileSync(new URL('../../qhat-scene/tests/saved.txt', import.meta.url), 'utf8')
  .split('\n')
  .filter((line) => line !== '' && !line.startsWith('#'))
  .map((line) => line.split(/\s+/));
const scenes = new Map(qhat.shipped_scenes().map((scene) => [scene.name, scene.text]));

/** FNV-1a, 64 bits, over bytes. The value is kept in two halves, because BigInt takes a microsecond a byte. */
function hashOf(bytes) {
  let [high, low] = [0xcbf29ce4, 0x84222325];
  for (const byte of bytes) {
    low = (low ^ byte) >>> 0;
    // times 2⁴⁰ + 0x1b3, modulo 2⁶⁴
    const product = low * 0x1b3;
    high = (Math.imul(high, 0x1b3) + Math.floor(product / 2 ** 32) + (low << 8)) >>> 0;
    low = product >>> 0;
  }
  return [high, low].map((half) => half.toString(16).padStart(8, '0')).join('');
}

/** The same over the bytes of arrays of numbers, least significant first. */
function hash(...arrays) {
  const numbers = arrays.flatMap((array) => Array.from(array));
  const view = new DataView(new ArrayBuffer(8 * numbers.length));
  numbers.forEach((number, k) => view.setFloat64(8 * k, number, true));
  return hashOf(new Uint8Array(view.buffer));
}

test('there are cases', () => assert.ok(cases.length >= 20));

for (const [scene, integrator, h, steps, expected] of cases) {
  test(`${scene} under ${integrator}: ${steps} steps of ${h} s`, () => {
    assert.ok(scenes.has(scene), `no scene is called ${scene}`);
    const simulation = new qhat.Simulation(scenes.get(scene), `${scene}.toml`, 'toml');
    try {
      simulation.set_controls({ ...simulation.controls(), integrator, h: Number(h) });
      for (let step = 0; step < Number(steps); step += 1) simulation.step();
      const bits = hash(simulation.positions(), simulation.velocities(), simulation.terms().multipliers);
      assert.equal(bits, expected);
    } finally {
      simulation.free();
    }
  });
}

test('every shipped scene is saved', () => assert.equal(saved.length, scenes.size));

for (const [scene, expected] of saved) {
  test(`${scene} goes on from saved bytes to the bytes of the native engine`, () => {
    let simulation = new qhat.Simulation(scenes.get(scene), `${scene}.toml`);
    try {
      for (let frame = 0; frame < 10; frame += 1) {
        const bytes = simulation.to_bytes();
        simulation.free();
        simulation = new qhat.Simulation(scenes.get(scene), `${scene}.toml`);
        simulation.restore(bytes);
        simulation.step();
      }
      assert.equal(hashOf(simulation.to_bytes()), expected);
    } finally {
      simulation.free();
    }
  });
}
