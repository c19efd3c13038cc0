export {default as Delaunay} from "./delaunay.js";
export {default as Voronoi} from "./voronoi.js";
