// The program of a page with one tree, which `corcast export T -o P.html` writes.
import { readPage, Tree } from "./tree.js";
import { begin } from "./viewer.js";

begin(new Tree(readPage()));
