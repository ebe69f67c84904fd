// Pictures for a person to look at, in tests/screenshots (not kept in git): both themes, a wide window and a phone.

import { mkdirSync, statSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { expect, it } from 'vitest';
import { atStart, laboratory, step } from './page';

const lab = laboratory();
const FOLDER = fileURLToPath(new URL('../screenshots/', import.meta.url));
const WIDE = { viewport: { width: 1280, height: 800 } };
const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true };

it.each([
  ['strandbeest', WIDE, 'light', ''],
  ['strandbeest', PHONE, 'dark', 'controls'],
  ['net', WIDE, 'dark', ''],
  ['hanging-chain', WIDE, 'light', 'ghost'],
  ['hanging-chain', PHONE, 'light', 'plots'],
  ['classic', WIDE, 'dark', 'terms'],
  ['classic', PHONE, 'light', ''],
  ['cube', PHONE, 'dark', 'terms'],
] as const)('%s %o %s %s', async (scene, size, colorScheme, panel) => {
  mkdirSync(FOLDER, { recursive: true });
  const { page, errors } = await lab.open(`/?scene=${scene}`, { ...size, colorScheme });
  await atStart(page);
  if (panel === 'ghost') await page.getByTestId('compare').check();
  else if (panel) await page.getByTestId(`tab-${panel}`).click();
  await step(page, 60);
  await page.keyboard.press(']');
  // two frames: one to draw the state, one to be sure that it was
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(width).toBe(size.viewport.width);
  const name = [scene, size === PHONE ? 'phone' : 'wide', colorScheme, panel].filter(Boolean).join('-');
  await page.screenshot({ path: `${FOLDER}${name}.png` });
  // an empty canvas compresses to far less
  expect(statSync(`${FOLDER}${name}.png`).size).toBeGreaterThan(15_000);
  expect(errors).toEqual([]);
});
