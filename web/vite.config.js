// One html file: the viewer with its style, and a place where `deltalux export` puts the solution.
import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

const three = readFileSync(new URL('node_modules/three/LICENSE', import.meta.url), 'utf8').trim();
const head = `<!--
This page was written by deltalux (Apache-2.0). It bundles three.js:

${three}
-->
`;

export default defineConfig({
  base: './',
  build: { target: 'es2022', assetsInlineLimit: 1 << 26, cssCodeSplit: false, modulePreload: false },
  plugins: [
    viteSingleFile({ removeViteModuleLoader: true }),
    {
      // The viewer stands between what its first picture needs and all else, and does not wait for that.
      name: 'order',
      enforce: 'post',
      generateBundle: {
        order: 'post',
        handler(_, bundle) {
          for (const part of Object.values(bundle)) {
            if (!part.fileName.endsWith('.html')) continue;
            const page = part.source.toString(), begin = page.indexOf('<script type="module"'), end = page.indexOf('</script>', begin) + 9;
            const viewer = page.slice(begin, end).replace(/^<script[^>]*>/, '<script type="module" async>'), rest = page.slice(0, begin) + page.slice(end);
            const at = rest.indexOf('<script id="later"');
            part.source = rest.slice(0, at) + viewer + '\n' + rest.slice(at);
          }
        },
      },
    },
    {
      name: 'licences',
      enforce: 'post',
      generateBundle(_, bundle) {
        for (const part of Object.values(bundle))
          if (part.fileName.endsWith('.html'))
            part.source = part.source.toString().replace(/^<!doctype html>\n?/i, '<!doctype html>\n' + head);
      },
    },
  ],
});
