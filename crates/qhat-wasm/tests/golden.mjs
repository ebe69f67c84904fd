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
const scenes = new Map(qhat.shipped_scenes().map((scene) => [scene.name, scene.text]));

/** FNV-1a, 64 bits, over the bytes of arrays of numbers, least significant first. */
function hash(...arrays) {
  let value = 0xcbf29ce484222325n;
  for (const array of arrays) {
    const view = new DataView(new ArrayBuffer(8));
    for (const number of array) {
      view.setFloat64(0, number, true);
      for (let i = 0; i < 8; i += 1) {
        value = BigInt.asUintN(64, (value ^ BigInt(view.getUint8(i))) * 0x100000001b3n);
      }
    }
  }
  return value.toString(16).padStart(16, '0');
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
