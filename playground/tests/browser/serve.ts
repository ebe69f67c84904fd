// Serves the built page on 127.0.0.1 as `qhat play` does: its files, and its scene at /scene or 204.

import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const DIST = fileURLToPath(new URL('../../dist/', import.meta.url));
const TYPES: Record<string, string> = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
};

export interface Served {
  origin: string;
  /** what /scene answers with */
  scene: { name: string; text: string } | null;
  close(): void;
}

export async function serve(): Promise<Served> {
  const served: Served = { origin: '', scene: null, close: () => server.close() };
  const server = createServer(async (request, response) => {
    const path = new URL(request.url ?? '/', 'http://localhost').pathname;
    if (path === '/scene') {
      if (!served.scene) return response.writeHead(204).end();
      const headers = {
        'x-qhat-scene-name': encodeURIComponent(served.scene.name),
        'content-type': 'text/plain',
      };
      return response.writeHead(200, headers).end(served.scene.text);
    }
    const file = join(DIST, normalize(path === '/' ? '/index.html' : path));
    try {
      const body = await readFile(file);
      return response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' }).end(body);
    } catch {
      return response.writeHead(404).end();
    }
  });
  await new Promise<void>((ready) => server.listen(0, '127.0.0.1', ready));
  served.origin = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
  return served;
}
