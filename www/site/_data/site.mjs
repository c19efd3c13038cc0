import { readFileSync } from 'node:fs';

const { repository, version } = JSON.parse(
  readFileSync(new URL('../../../web/package.json', import.meta.url), 'utf8'),
);

export default {
  version,
  repository: repository.url.replace(/^git\+|\.git$/g, ''),
  navigation: [
    { title: 'Demo', url: '/' },
    { title: 'Examples', url: '/examples/' },
    { title: 'Guide', url: '/guide/' },
    { title: 'API', url: '/api/' },
    { title: 'Benchmarks', url: '/benchmarks/' },
  ],
};
