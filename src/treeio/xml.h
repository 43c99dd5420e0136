/* Reads an XML document as a sequence of elements. Private to the module treeio.
 *
 * xml_read calls two handlers of the caller: `begin` at the start tag of an element, with its
 * attributes, and `end` at the end tag, with the text in the element. Names come without their
 * namespace prefixes. A handler may call xml_line, xml_depth, xml_ancestor and xml_offset, which
 * describe the position of the current element, and xml_stop.
 *
 * Documents that declare entities are refused: an expanded entity could make a document much larger
 * than its file. */
#ifndef CORCAST_TREEIO_XML_H
#define CORCAST_TREEIO_XML_H

#include "base/base.h"

typedef struct Xml Xml;

/* The start tag of an element. Valid until the handler returns. */
typedef struct XmlElement {
    const char *name;
    const char **attributes; /* name, value, name, value, ..., NULL */
} XmlElement;

/* The functions that are called for each element. Either pointer may be NULL. `reader` is the
 * argument of xml_read. An error ends the reading. xml_read puts file and line in front of the
 * sentence of STATUS_INPUT. */
typedef struct XmlHandlers {
    Status (*begin)(void *reader, Xml *xml, const XmlElement *element, Err *err);
    /* `text` is the text of the element without the text of elements inside it, zero-terminated,
     * with leading and trailing blanks removed. The handler may change it. */
    Status (*end)(void *reader, Xml *xml, const char *name, char *text, Err *err);
} XmlHandlers;

/* Reads a document.
 *
 * name     the name of the file, for errors.
 * bytes    the document, `size` bytes; need not be zero-terminated.
 * reader   data of the caller, which is passed to the handlers.
 * Errors   those of the handlers, with file and line; STATUS_INPUT, with file and line, if the
 *          document is not well formed, declares entities, or has elements nested more than 64
 *          levels deep; STATUS_MEMORY. */
MUST_CHECK Status xml_read(const char *name, const char *bytes, size_t size,
                           const XmlHandlers *handlers, void *reader, Err *err);

/* Returns the value of the attribute `name`, or NULL if the element has no such attribute. */
const char *xml_attribute(const XmlElement *element, const char *name);
/* Finds the value of the attribute `name`. Errors: STATUS_INPUT, without file and line, if the
 * element has no such attribute. */
MUST_CHECK Status xml_require_attribute(const XmlElement *element, const char *name,
                                        const char **value, Err *err);

/* The next five functions may only be called in a handler. */
/* Returns the line of the current element in the file, from 1. */
size_t xml_line(const Xml *xml);
/* Returns the number of elements that contain the current element. */
size_t xml_depth(const Xml *xml);
/* Returns the name of the current element's ancestor, `up` levels out (1: the parent); "" if there
 * is no such element. Valid until the handler returns. */
const char *xml_ancestor(const Xml *xml, size_t up);
/* Returns the number of bytes of the file before the current element. */
size_t xml_offset(const Xml *xml);
/* Makes xml_read return STATUS_OK after the current handler, which must return STATUS_OK. The rest
 * of the file need not be XML. */
void xml_stop(Xml *xml);

/* Returns true if the outermost element of a document is called `element`. `start` has the first
 * bytes of the document and a final zero. */
bool xml_begins(const char *start, const char *element);

#endif
