/* XML for the readers of its dialects: elements one after another, names without their prefixes.
 * Documents that declare entities are refused, so that none can be larger than its file. */
#ifndef CORCAST_TREEIO_XML_H
#define CORCAST_TREEIO_XML_H

#include "base/base.h"

typedef struct Xml Xml;

/* An element that begins. Borrowed until the handler returns. */
typedef struct XmlElement {
    const char *name;
    const char **attribute; /* names and values in turns; ends with NULL */
} XmlElement;

/* What becomes of the elements; errors as STATUS_INPUT without file and line. Each may be NULL. */
typedef struct XmlHandlers {
    Status (*begin)(void *reader, Xml *xml, const XmlElement *element, Err *err);
    /* `text` is what stands directly in the element, zero-terminated, without blanks at both ends;
     * may be changed. */
    Status (*end)(void *reader, Xml *xml, const char *name, char *text, Err *err);
} XmlHandlers;

/* Reads a document; `name` is the file's. STATUS_INPUT, with file and line, when it is not well
 * formed, declares entities, or is nested deeper than 64 elements. */
MUST_CHECK Status xml_read(const char *name, const char *bytes, size_t size,
                           const XmlHandlers *handlers, void *reader, Err *err);

/* The value of an attribute; NULL when the element has none of the name. */
const char *xml_attribute(const XmlElement *element, const char *name);
/* Likewise, or else STATUS_INPUT. */
MUST_CHECK Status xml_needed(const XmlElement *element, const char *name, const char **value,
                             Err *err);

/* Of what is handled now: its line, the number of elements around it, and the name of the element
 * `up` steps further out, 1 its parent; "" when there is none. */
size_t xml_line(const Xml *xml);
size_t xml_depth(const Xml *xml);
const char *xml_around(const Xml *xml, size_t up);
/* For a handler: nothing more is read, and the rest need not be XML. */
void xml_stop(Xml *xml);
/* The number of bytes before what is handled now. */
size_t xml_byte(const Xml *xml);

/* Whether a document that begins with these bytes has this element around all others. */
bool xml_begins(const char *start, const char *element);

#endif
