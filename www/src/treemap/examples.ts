/** Tables to begin with. */
export interface Example {
  title: string;
  /** What the numbers are, for the description of the picture. */
  unit: string;
  csv: string;
}

/** Millions of people in 2024, rounded: United Nations, World Population Prospects 2024. */
const PEOPLE = `Country,Continent,Million people
India,Asia,1451
China,Asia,1419
Indonesia,Asia,283
Pakistan,Asia,251
Bangladesh,Asia,174
Japan,Asia,124
Philippines,Asia,116
Vietnam,Asia,101
Iran,Asia,92
Turkey,Asia,87
Thailand,Asia,72
Myanmar,Asia,55
South Korea,Asia,52
Iraq,Asia,46
Afghanistan,Asia,43
Yemen,Asia,41
Uzbekistan,Asia,36
Malaysia,Asia,36
Saudi Arabia,Asia,34
Nepal,Asia,30
Nigeria,Africa,233
Ethiopia,Africa,132
Egypt,Africa,117
DR Congo,Africa,109
Tanzania,Africa,69
South Africa,Africa,64
Kenya,Africa,56
Sudan,Africa,50
Uganda,Africa,50
Algeria,Africa,47
Morocco,Africa,38
Angola,Africa,38
Mozambique,Africa,35
Ghana,Africa,34
Madagascar,Africa,32
Ivory Coast,Africa,32
Cameroon,Africa,29
Russia,Europe,145
Germany,Europe,85
United Kingdom,Europe,69
France,Europe,67
Italy,Europe,59
Spain,Europe,48
Poland,Europe,39
Ukraine,Europe,38
Romania,Europe,19
Netherlands,Europe,18
Belgium,Europe,12
Sweden,Europe,11
Portugal,Europe,10
Greece,Europe,10
United States,North America,345
Mexico,North America,131
Canada,North America,40
Guatemala,North America,18
Haiti,North America,12
Dominican Republic,North America,11
Cuba,North America,11
Honduras,North America,11
Brazil,South America,212
Colombia,South America,53
Argentina,South America,46
Peru,South America,34
Venezuela,South America,28
Chile,South America,20
Ecuador,South America,18
Bolivia,South America,12
Australia,Oceania,27
Papua New Guinea,Oceania,11
New Zealand,Oceania,5
`;

/** The elements of a human body by mass. */
const BODY = `Element,Percent of the mass of a body
Oxygen,65
Carbon,18.5
Hydrogen,9.5
Nitrogen,3.2
Calcium,1.5
Phosphorus,1
Potassium,0.4
Sulfur,0.3
Sodium,0.2
Chlorine,0.2
Magnesium,0.1
`;

/** Numbers from 1 to 100, as many smaller as larger ones by their logarithm: the same in every visit. */
function many(count: number): string {
  let state = 1;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return (state >>> 0) / 2 ** 32;
  };
  const rows = Array.from({ length: count }, (_, i) => `${i + 1},${(100 ** random()).toFixed(2)}`);
  return `Cell,Value\n${rows.join('\n')}\n`;
}

export const EXAMPLES: Record<string, Example> = {
  people: { title: 'People by country', unit: 'million people', csv: PEOPLE },
  body: { title: 'What a body is made of', unit: 'percent', csv: BODY },
  many: { title: '3,000 cells', unit: '', csv: many(3000) },
};
