export default {
  layout: 'article.njk',
  section: 'entries',
  eleventyComputed: { kind: ({ member }) => member || 'API' },
};
