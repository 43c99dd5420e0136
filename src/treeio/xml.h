/* Reads XML for its dialects: one element after another, with names without their prefixes. Refuses
 * documents that declare entities, so that no document can be larger than its file. */
#ifndef CORCAST_TREEIO_XML_H
#define CORCAST_TREEIO_XML_H

#include "base/base.h"

typedef struct Xml Xml;

/* An element that begins. Borrowed until the handler returns. */
typedef struct XmlElement {
    const char *name;
    const char **attribute; /* names and values in turns; ends with NULL */
} XmlElement;

/* Called for each element; either may be NULL. Errors: STATUS_INPUT, without file and line. */
typedef struct XmlHandlers {
    Status (*begin)(void *reader, Xml *xml, const XmlElement *element, Err *err);
    /* `text` is the text directly in the element, zero-terminated, without blanks at both ends. It
     * may be changed. */
    Status (*end)(void *reader, Xml *xml, const char *name, char *text, Err *err);
} XmlHandlers;

/* Reads a document. `name` is the file's. Errors: as the handlers, with file and line; STATUS_INPUT
 * if the document is not well formed, declares entities, or is nested deeper than 64 elements;
 * STATUS_MEMORY. */
MUST_CHECK Status xml_read(const char *name, const char *bytes, size_t size,
                           const XmlHandlers *handlers, void *reader, Err *err);

/* Returns the value of an attribute, or NULL if the element has none of this name. */
const char *xml_attribute(const XmlElement *element, const char *name);
/* Finds the value of an attribute. Errors: STATUS_INPUT, without file and line, if there is none.
 */
MUST_CHECK Status xml_require(const XmlElement *element, const char *name, const char **value,
                              Err *err);

/* For a handler: the line of the current element; the number of elements around it; and the name of
 * the element `up` steps further out (1: its parent), or "" if there is none. */
size_t xml_line(const Xml *xml);
size_t xml_depth(const Xml *xml);
const char *xml_ancestor(const Xml *xml, size_t up);
/* For a handler: stops reading. The rest need not be XML. */
void xml_stop(Xml *xml);
/* For a handler: the number of bytes before the current element. */
size_t xml_byte(const Xml *xml);

/* Returns true if the outermost element of a document that begins with these bytes has this name.
 */
bool xml_begins(const char *start, const char *element);

#endif
