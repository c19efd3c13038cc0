export default { layout: 'article.njk', section: 'guide', kind: 'Guide' };
