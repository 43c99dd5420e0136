/* The public header of the module web: the program of the page that grows trees, compiled to
 * WebAssembly [templates/grow/].
 *
 * The page's worker calls these functions. There is one tree at a time: the one that web_grow made
 * last. Texts go in and bytes come out through memory of the module: web_input gives room for a
 * text, and web_bytes and web_size describe the result of the last call. A function that can fail
 * returns 0 on success, and else the exit status that the program has for this failure; web_bytes
 * is then one sentence. The page offers no files, so an option that names a file fails. */
#ifndef CORCAST_WEB_WEB_H
#define CORCAST_WEB_WEB_H

#include <stddef.h>

/* Exported to JavaScript under the function's own name. */
#ifdef __wasm__
#define WEB_EXPORT(name) __attribute__((export_name(#name)))
#else
#define WEB_EXPORT(name)
#endif

/* Returns room for a text of `size` bytes and its final zero, which stays valid until the next
 * call. NULL if memory runs out. */
WEB_EXPORT(web_input) char *web_input(size_t size);

/* The bytes of the last result, and their number. The bytes stay valid until the next call. */
WEB_EXPORT(web_bytes) const char *web_bytes(void);
WEB_EXPORT(web_size) size_t web_size(void);

/* Grows a tree as `corcast grow` does, and refines it if asked. The input has one option per line,
 * "NAME=VALUE", without dashes. The result is the command line that makes the tree, then the notes
 * and warnings of the operation, one per line, each after "note: " or "warning: ". After an error
 * the tree before stays. */
WEB_EXPORT(web_grow) int web_grow(void);

/* The tree as an SWC file: the bytes that `corcast grow -o T.swc` writes. */
WEB_EXPORT(web_swc) int web_swc(void);
/* The surface of the tree as an STL file. The input has options of `corcast export`, as web_grow's
 * of `corcast grow`. */
WEB_EXPORT(web_stl) int web_stl(void);

/* The nodes of the tree, as little-endian arrays one after another: float x, y, z per node, mm;
 * float radius per node, mm; uint32 index of the parent per node, a root's own; uint32 id per
 * node. */
WEB_EXPORT(web_nodes) int web_nodes(void);

/* The number of fields that trees may have. */
WEB_EXPORT(web_fields) size_t web_fields(void);
/* The field whose number, from 0, is the input: the line "name<TAB>title<TAB>unit" and its final
 * zero, then as many bytes that the size is a multiple of 4, then a float per node, NAN for no
 * value. Empty if the tree lacks what the field needs. */
WEB_EXPORT(web_field) int web_field(void);

/* What `corcast info` tells of the tree: lines "key<TAB>value", with the keys of its JSON. */
WEB_EXPORT(web_summary) int web_summary(void);

#endif
