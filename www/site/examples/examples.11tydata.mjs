export default { layout: 'article.njk', section: 'examples', kind: 'Example' };
