/* The public header of the module web: the functions that the web page of `grow` [templates/grow/]
 * calls. They are compiled to WebAssembly, and called by the page's JavaScript worker.
 *
 * The module has one global tree: the result of the last successful web_grow. Before that, the tree
 * is empty.
 *
 * To call a function that has an input, the worker calls web_input, writes the text to the buffer
 * that web_input returns, and calls the function. web_bytes and web_size return the function's
 * result, a sequence of bytes. A function that returns int returns 0 on success. On failure it
 * returns the exit status that `corcast` has for this failure, and the result is one sentence. The
 * page has no files, so an option that names a file fails. */
#ifndef CORCAST_WEB_WEB_H
#define CORCAST_WEB_WEB_H

#include <stddef.h>

/* Exports the function to JavaScript under its own name. */
#ifdef __wasm__
#define WEB_EXPORT(name) __attribute__((export_name(#name)))
#else
#define WEB_EXPORT(name)
#endif

/* Returns a buffer of `size` + 1 bytes for an input. Its last byte is 0. The buffer stays
 * valid until the next call of web_input. Returns NULL if memory runs out. */
WEB_EXPORT(web_input) char *web_input(size_t size);

/* Return the bytes of the last result, and the number of bytes. The bytes stay valid until the next
 * call of a function that makes a result. */
WEB_EXPORT(web_bytes) const char *web_bytes(void);
WEB_EXPORT(web_size) size_t web_size(void);

/* Grows a tree as `corcast grow` does, with the same options. The input has one option per line,
 * "NAME=VALUE", where NAME has no dashes in front. The first line of the result is the command line
 * that makes the same tree. Each further line is a note or a warning of the operation, and begins
 * with "note: " or "warning: ". After an error the previous tree is kept. */
WEB_EXPORT(web_grow) int web_grow(void);

/* Makes the tree as an SWC file: the bytes that `corcast grow -o T.swc` writes. */
WEB_EXPORT(web_swc) int web_swc(void);
/* Makes the surface of the tree as an STL file. The input has options of `corcast export`, in the
 * form of web_grow. */
WEB_EXPORT(web_stl) int web_stl(void);

/* Makes four little-endian arrays of the nodes of the tree, one after the other: float x, y and z
 * per node, mm; float radius per node, mm; uint32 index of the parent per node, or of the node
 * itself for a root; uint32 id per node. */
WEB_EXPORT(web_nodes) int web_nodes(void);

/* Returns the number of fields that `corcast` can compute for a tree. Makes no result. */
WEB_EXPORT(web_fields) size_t web_fields(void);
/* Computes a field. The input is its index in decimal, from 0 to web_fields() - 1. The result is
 * the text "name<TAB>title<TAB>unit" with a final zero, then zeros up to a multiple of 4 bytes,
 * then a little-endian float per node, NaN where there is no value. The result is empty, without an
 * error, if there is no such field or if the tree lacks a quantity that the field needs. */
WEB_EXPORT(web_field) int web_field(void);

/* Makes a summary of the tree: lines "key<TAB>value", with keys and values of the JSON that
 * `corcast info` prints. */
WEB_EXPORT(web_summary) int web_summary(void);

#endif
