/* Reads an XML document: calls the reader's handlers at the start and the end of each element.
 * expat parses the document.
 *
 * One buffer holds the texts of all open elements, from the outermost to the innermost. text_at
 * marks where the text of each element begins. When an element ends, its text is cut off the
 * buffer, so the text of the parent goes on without it. A second buffer holds the names of the open
 * elements in the same way. */
#include "treeio/xml.h"

#include <expat.h>
#include <stdlib.h>
#include <string.h>

/* The document is parsed in chunks of 1 MB, because expat takes the size of a chunk as an int.
 * MAX_DEPTH is the maximum number of elements around another. The formats nest at most ten; deeper
 * documents are refused, so that no document takes much memory. */
enum { MAX_DEPTH = 64, CHUNK = 1 << 20 };

/* A stack of characters, with a zero after the last one. */
typedef ARRAY(char) Chars;

struct Xml {
    XML_Parser parser;
    const XmlHandlers *handlers;
    void *reader;
    Chars text, names;
    size_t text_at[MAX_DEPTH], name_at[MAX_DEPTH];
    size_t depth;
    bool stopped;  /* xml_stop was called */
    Status status; /* the first error of a handler */
    Err *err;
};

/* Returns a name without its namespace prefix. */
static const char *local_name(const char *name)
{
    const char *colon = strrchr(name, ':');
    return colon ? colon + 1 : name;
}

/* Stops the parser if `status` is an error. */
static void check(Xml *xml, Status status)
{
    if (status == STATUS_OK)
        return;
    xml->status = status;
    XML_StopParser(xml->parser, XML_FALSE);
}

static Status append(Chars *chars, const char *more, size_t length, Err *err)
{
    TRY(ARRAY_RESERVE(chars, length + 1, "characters of XML", err));
    memcpy(chars->items + chars->n, more, length);
    chars->n += length;
    chars->items[chars->n] = '\0';
    return STATUS_OK;
}

/* Removes the blanks and line ends at both ends of a text, in place. Returns the rest. */
static char *trim(char *text)
{
    static const char blanks[] = " \t\r\n";
    text += strspn(text, blanks);
    size_t length = strlen(text);
    while (length > 0 && strchr(blanks, text[length - 1]))
        text[--length] = '\0';
    return text;
}

static Status begin(Xml *xml, const XmlElement *element, Err *err)
{
    if (xml->depth == MAX_DEPTH)
        return err_set(err, STATUS_INPUT, "elements are nested more than %d levels deep",
                       MAX_DEPTH);
    if (xml->handlers->begin)
        TRY(xml->handlers->begin(xml->reader, xml, element, err));
    xml->text_at[xml->depth] = xml->text.n;
    xml->name_at[xml->depth++] = xml->names.n;
    return append(&xml->names, element->name, strlen(element->name) + 1, err);
}

static void XMLCALL on_begin(void *context, const XML_Char *name, const XML_Char **attribute)
{
    Xml *xml = context;
    const XmlElement element = {local_name(name), attribute};
    check(xml, begin(xml, &element, xml->err));
}

static Status end(Xml *xml, const char *name, Err *err)
{
    size_t at = xml->text_at[--xml->depth];
    xml->names.n = xml->name_at[xml->depth];
    if (xml->handlers->end) {
        TRY(append(&xml->text, "", 0, err));
        TRY(xml->handlers->end(xml->reader, xml, name, trim(xml->text.items + at), err));
    }
    xml->text.n = at;
    return STATUS_OK;
}

static void XMLCALL on_end(void *context, const XML_Char *name)
{
    Xml *xml = context;
    if (xml->status == STATUS_OK) /* expat ends an empty element even if its start tag failed */
        check(xml, end(xml, local_name(name), xml->err));
}

static void XMLCALL on_text(void *context, const XML_Char *chars, int length)
{
    Xml *xml = context;
    if (xml->handlers->end && xml->status == STATUS_OK)
        check(xml, append(&xml->text, chars, (size_t)length, xml->err));
}

static void XMLCALL on_entity(void *context, const XML_Char *name, int is_parameter,
                              const XML_Char *value, int length, const XML_Char *base,
                              const XML_Char *system, const XML_Char *public,
                              const XML_Char *notation)
{
    (void)is_parameter, (void)value, (void)length, (void)base, (void)system, (void)public,
        (void)notation;
    Xml *xml = context;
    check(xml, err_set(xml->err, STATUS_INPUT,
                       "it declares the entity '%.40s'; remove all entity declarations", name));
}

/* Reports an error of the parser itself. */
static Status failure(const Xml *xml, Err *err)
{
    enum XML_Error code = XML_GetErrorCode(xml->parser);
    if (code == XML_ERROR_NO_MEMORY)
        return mem_out_of("to parse", "XML", err);
    return err_set(err, STATUS_INPUT, "not well-formed XML: %s", XML_ErrorString(code));
}

static Status parse(Xml *xml, const char *bytes, size_t size, Err *err)
{
    for (size_t done = 0, part; !xml->stopped; done += part) {
        part = size - done < CHUNK ? size - done : CHUNK;
        bool is_last = part == size - done;
        if (XML_Parse(xml->parser, bytes + done, (int)part, is_last) != XML_STATUS_OK &&
            !xml->stopped)
            return xml->status != STATUS_OK ? xml->status : failure(xml, err);
        if (is_last)
            break;
    }
    return STATUS_OK;
}

Status xml_read(const char *name, const char *bytes, size_t size, const XmlHandlers *handlers,
                void *reader, Err *err)
{
    Err own;
    Xml xml = {.handlers = handlers, .reader = reader, .err = err ? err : &own};
    xml.parser = XML_ParserCreate(NULL);
    if (!xml.parser)
        return mem_out_of("to parse", name, err);
    XML_SetUserData(xml.parser, &xml);
    XML_SetElementHandler(xml.parser, on_begin, on_end);
    XML_SetCharacterDataHandler(xml.parser, on_text);
    XML_SetEntityDeclHandler(xml.parser, on_entity);
    Status status = parse(&xml, bytes, size, xml.err);
    if (status == STATUS_INPUT)
        err_prefix(xml.err, "%s:%zu: ", name, xml_line(&xml));
    XML_ParserFree(xml.parser);
    ARRAY_RELEASE(&xml.text);
    ARRAY_RELEASE(&xml.names);
    return status;
}

const char *xml_attribute(const XmlElement *element, const char *name)
{
    for (const char **at = element->attributes; *at; at += 2)
        if (strcmp(local_name(at[0]), name) == 0)
            return at[1];
    return NULL;
}

Status xml_require_attribute(const XmlElement *element, const char *name, const char **value,
                             Err *err)
{
    const char *found = xml_attribute(element, name);
    if (!found)
        return err_set(err, STATUS_INPUT, "the element <%.40s> has no attribute %s", element->name,
                       name);
    *value = found;
    return STATUS_OK;
}

size_t xml_line(const Xml *xml)
{
    return XML_GetCurrentLineNumber(xml->parser);
}

size_t xml_depth(const Xml *xml)
{
    return xml->depth;
}

const char *xml_ancestor(const Xml *xml, size_t up)
{
    return up <= xml->depth && up > 0 ? xml->names.items + xml->name_at[xml->depth - up] : "";
}

void xml_stop(Xml *xml)
{
    xml->stopped = true;
    XML_StopParser(xml->parser, XML_FALSE);
}

size_t xml_offset(const Xml *xml)
{
    return (size_t)XML_GetCurrentByteIndex(xml->parser);
}

bool xml_begins(const char *start, const char *element)
{
    for (const char *at = strchr(start, '<'); at; at = strchr(at + 1, '<')) {
        if (strncmp(at, "<!--", 4) == 0 && !(at = strstr(at, "-->")))
            return false;
        if (at[0] != '<' || at[1] == '!' || at[1] == '?')
            continue;
        size_t length = strcspn(at + 1, " \t\n/>");
        const char *colon = memchr(at + 1, ':', length);
        const char *name = colon ? colon + 1 : at + 1;
        return (size_t)(at + 1 + length - name) == strlen(element) &&
               strncmp(name, element, strlen(element)) == 0;
    }
    return false;
}
