import { readFileSync } from 'node:fs';
import { expect, it } from 'vitest';

it('the lock file names no host to fetch from, and has the packages of every platform', () => {
  const { packages } = JSON.parse(readFileSync(new URL('../../package-lock.json', import.meta.url), 'utf8'));
  const entries = Object.entries<{ resolved?: string; optionalDependencies?: Record<string, string> }>(
    packages,
  );
  expect(entries.filter(([, { resolved }]) => resolved).map(([name]) => name)).toEqual([]);
  const optional = entries.flatMap(([, entry]) => Object.keys(entry.optionalDependencies ?? {}));
  expect(optional.length).toBeGreaterThan(0);
  expect(optional.filter((name) => !packages[`node_modules/${name}`])).toEqual([]);
});
