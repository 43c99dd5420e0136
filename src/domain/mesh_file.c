/* Reads the triangles of a mesh from an STL file (binary or ASCII) or an OBJ file.
 *
 * A binary STL file is recognised by its size, 84 + 50 n bytes with the n that it states, because
 * its 80-byte title may begin with "solid" as an ASCII file does. A file that contains zero bytes
 * may also be longer, because some programs write more data after the triangles. Keywords of an
 * ASCII file may be in capitals, "end loop" may be two words, and the text after "endsolid" is not
 * read. Normals, colors, textures and groups are not read: the outside of a triangle is the side
 * from which its corners run counter-clockwise. */
#include "domain/mesh.h"

#include "domain/kinds.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Bytes of a binary STL file: of its title, its header, one triangle, and the normal of a triangle,
 * which its corners follow. */
enum { STL_TITLE = 80, STL_HEADER = 84, STL_FACET = 50, STL_CORNERS = 12 };
enum { SHOWN = 40 }; /* characters of a bad word in a message */
enum { MAX_TRIANGLES = INT32_MAX / 3 };

static const FileForm obj_file = {.name = "an OBJ file", .most_bytes = 8e9, .is_text = true};
static const FileForm stl_file = {.name = "an STL file", .most_bytes = 8e9};

/* The state of reading a file. */
typedef struct MeshReader {
    Soup *soup;
    const char *path;
    double mm;
    size_t line;    /* counted from 1 */
    Vec3 *vertices; /* of an OBJ file, or of the facet of an STL file being read; owned */
    size_t n, capacity;
    bool has_ended;   /* STL: the last keyword was endsolid */
    Vec3 first, last; /* OBJ: corners of the face being read */
    int corners;      /* OBJ: number of corners of the present face so far */
    bool goes_on;     /* OBJ: the last line was of a face and ended in a backslash */
} MeshReader;

/* Adds a triangle to those that were read. */
static Status add_triangle(MeshReader *reader, Vec3 a, Vec3 b, Vec3 c, Err *err)
{
    Soup *soup = reader->soup;
    if (soup->n / 3 == MAX_TRIANGLES)
        return err_set(err, STATUS_INPUT, "%s: has more than %d triangles", reader->path,
                       MAX_TRIANGLES);
    TRY(mem_reserve(&soup->corners, &soup->capacity, soup->n + 3, sizeof *soup->corners,
                    "corners of triangles", err));
    soup->corners[soup->n++] = a;
    soup->corners[soup->n++] = b;
    soup->corners[soup->n++] = c;
    return STATUS_OK;
}

/* Returns the unsigned number of 4 bytes, lowest byte first. */
static uint32_t little_endian(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Returns the IEEE single of 4 bytes, lowest byte first. */
static double stl_float(const char *bytes)
{
    uint32_t bits = little_endian(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

/* Returns the size of a binary STL file of as many triangles as this one states. */
static size_t stated_size(const char *bytes)
{
    return STL_HEADER + (size_t)STL_FACET * little_endian(bytes + STL_TITLE);
}

static bool is_binary_stl(const char *bytes, size_t size)
{
    if (size < STL_HEADER)
        return false;
    size_t stated = stated_size(bytes);
    return size == stated ||
           (size > stated && stated > STL_HEADER && memchr(bytes, '\0', stated) != NULL);
}

/* Checks that a file is a text, and sets *size to its length. Zero bytes after the text are allowed
 * and removed. A file with zero bytes within it must have been meant as a binary file of another
 * size. */
static Status check_ascii_stl(const char *path, char *bytes, size_t *size, Err *err)
{
    const char *word = bytes + strspn(bytes, TEXT_BLANKS "\r\n");
    bool is_named = strncasecmp(word, "solid", strlen("solid")) == 0;
    size_t length = *size;
    while (is_named && length > 0 && bytes[length - 1] == '\0')
        length--;
    if (!memchr(bytes, '\0', length)) {
        *size = length;
        return file_to_text(path, &stl_file, bytes, size, err);
    }
    if (*size < STL_HEADER)
        return err_set(err, STATUS_INPUT,
                       "%s: has %zu bytes, fewer than the %d before the triangles of a binary STL "
                       "file",
                       path, *size, STL_HEADER);
    return err_set(err, STATUS_INPUT,
                   "%s: is not a text; as a binary STL file with %u triangles it must have %zu "
                   "bytes, but it has %zu",
                   path, little_endian(bytes + STL_TITLE), stated_size(bytes), *size);
}

static Status read_binary_stl(MeshReader *reader, const char *bytes, Err *err)
{
    for (size_t at = STL_HEADER; at < stated_size(bytes); at += STL_FACET) {
        Vec3 corner[3];
        for (size_t i = 0; i < 3; i++) {
            const char *xyz = bytes + at + STL_CORNERS + 12 * i;
            corner[i] = vec3_scale(vec3(stl_float(xyz), stl_float(xyz + 4), stl_float(xyz + 8)),
                                   reader->mm);
            TRY(domain_check_point(reader->path, 0, corner[i], err));
        }
        TRY(add_triangle(reader, corner[0], corner[1], corner[2], err));
    }
    return STATUS_OK;
}

/* Sets the error of a bad word in the present line. */
static Status refuse_line(const MeshReader *reader, const char *what, const char *word, Err *err)
{
    return err_set(err, STATUS_INPUT, "%s:%zu: '%.*s' %s", reader->path, reader->line, SHOWN, word,
                   what);
}

/* Adds the vertex of the three numbers after `vertex` or `v`. The rest of the line is ignored. */
static Status add_vertex(MeshReader *reader, char **rest, Err *err)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        const char *word = strtok_r(NULL, TEXT_BLANKS, rest);
        if (!word || !number_parse(word, &value[i]))
            return refuse_line(reader,
                               word && strchr(word, ',')
                                   ? "has a comma; a vertex has three numbers, x y z, with "
                                     "decimal points and blanks between them"
                                   : "is not a number; a vertex has three, x y z",
                               word ? word : "", err);
    }
    Vec3 vertex = vec3_scale(vec3(value[0], value[1], value[2]), reader->mm);
    TRY(domain_check_point(reader->path, reader->line, vertex, err));
    TRY(mem_reserve(&reader->vertices, &reader->capacity, reader->n + 1, sizeof vertex, "vertices",
                    err));
    reader->vertices[reader->n++] = vertex;
    return STATUS_OK;
}

/* Returns the index of the keyword that the line begins with, or -1 if it begins with none. `word`
 * is the first word of the line; "end loop" counts as "endloop". */
static int find_keyword(const char *word, char **rest, const char *const *keywords, int n)
{
    static const char *const end = "end";
    bool is_split = strcasecmp(word, end) == 0;
    if (is_split)
        word = strtok_r(NULL, TEXT_BLANKS, rest);
    for (int i = 0; i < n && word; i++) {
        const char *keyword = keywords[i];
        if (is_split && strncmp(keyword, end, strlen(end)) != 0)
            continue;
        if (strcasecmp(word, is_split ? keyword + strlen(end) : keyword) == 0)
            return i;
    }
    return -1;
}

/* Reads a line of an ASCII STL file. A triangle is added at its "endloop". */
static Status read_stl_line(MeshReader *reader, char *line, Err *err)
{
    enum { VERTEX, END_LOOP, END_SOLID, SOLID, FACET, OUTER, END_FACET, KEYWORDS };
    static const char *const keywords[KEYWORDS] = {"vertex", "endloop", "endsolid", "solid",
                                                   "facet",  "outer",   "endfacet"};
    char *rest = NULL;
    const char *word = strtok_r(line, TEXT_BLANKS, &rest);
    if (!word)
        return STATUS_OK;
    int keyword = find_keyword(word, &rest, keywords, KEYWORDS);
    if (keyword < 0 && reader->has_ended)
        return STATUS_OK;
    if (keyword < 0)
        return refuse_line(reader,
                           "is not a keyword of an ASCII STL file, and the size of the file "
                           "is not that of a binary STL file",
                           word, err);
    reader->has_ended = keyword == END_SOLID;
    if (keyword == VERTEX)
        return add_vertex(reader, &rest, err);
    if (keyword != END_LOOP)
        return STATUS_OK;
    const Vec3 *corner = reader->vertices;
    if (reader->n != 3)
        return refuse_line(reader, "ends a facet that does not have three vertices", word, err);
    reader->n = 0;
    return add_triangle(reader, corner[0], corner[1], corner[2], err);
}

/* Finds one corner of a face: "7", "7/1", "7//3" or "7/1/3". The first number is the index of a
 * vertex; negative numbers count back from the last vertex. */
static Status find_corner(const MeshReader *reader, char *word, Vec3 *corner, Err *err)
{
    word[strcspn(word, "/")] = '\0';
    long long number = 0, n = (long long)reader->n;
    if (!integer_parse(word, -n, n, &number) || number == 0)
        return refuse_line(reader, "is not the index of a vertex above this line", word, err);
    *corner = reader->vertices[number > 0 ? number - 1 : n + number];
    return STATUS_OK;
}

/* Reads the corners of a face from one line. A face of more than three corners becomes a fan of
 * triangles around its first corner. */
static Status add_corners(MeshReader *reader, char **rest, Err *err)
{
    Vec3 corner;
    for (char *word; (word = strtok_r(NULL, TEXT_BLANKS, rest)); reader->corners++) {
        TRY(find_corner(reader, word, &corner, err));
        if (reader->corners >= 2)
            TRY(add_triangle(reader, reader->first, reader->last, corner, err));
        if (reader->corners == 0)
            reader->first = corner;
        reader->last = corner;
    }
    if (reader->corners < 3 && !reader->goes_on)
        return refuse_line(reader, "is a face of fewer than three corners", "f", err);
    return STATUS_OK;
}

/* Removes a backslash from the end of a line. It means that the next line continues this one. */
static bool cut_backslash(char *line)
{
    line = text_trim(line);
    size_t length = strlen(line);
    if (length == 0 || line[length - 1] != '\\')
        return false;
    line[length - 1] = '\0';
    return true;
}

/* Reads a line of an OBJ file: a vertex, a face, or the continuation of a face. Ignores all
 * others. */
static Status read_obj_line(MeshReader *reader, char *line, Err *err)
{
    static char face[] = "f";
    line[strcspn(line, "#")] = '\0';
    bool goes_on = cut_backslash(line), went_on = reader->goes_on;
    char *rest = line;
    const char *word = went_on ? face : strtok_r(line, TEXT_BLANKS, &rest);
    reader->goes_on = false;
    if (!word)
        return STATUS_OK;
    if (strcasecmp(word, "v") == 0)
        return add_vertex(reader, &rest, err);
    if (strcasecmp(word, "f") != 0)
        return STATUS_OK;
    reader->goes_on = goes_on;
    if (!went_on)
        reader->corners = 0;
    return add_corners(reader, &rest, err);
}

/* Calls read_line for each line of the text, and counts the lines for messages. */
static Status read_lines(MeshReader *reader, char *bytes,
                         Status (*read_line)(MeshReader *, char *, Err *), Err *err)
{
    for (char *line; (line = text_line(&bytes));) {
        reader->line++;
        TRY(read_line(reader, line, err));
    }
    return STATUS_OK;
}

Status soup_read(Soup *soup, const char *path, double mm, Err *err)
{
    char *bytes = NULL;
    size_t size = 0;
    bool is_obj = strcasecmp(file_extension(path), "obj") == 0;
    const FileForm *form = is_obj ? &obj_file : &stl_file;
    TRY(file_read(path, form, &bytes, &size, err));
    MeshReader reader = {.soup = soup, .path = path, .mm = mm};
    Status status = STATUS_OK;
    if (is_obj) {
        TRY_GOTO(read_lines(&reader, bytes, read_obj_line, err));
    } else if (is_binary_stl(bytes, size)) {
        TRY_GOTO(read_binary_stl(&reader, bytes, err));
    } else {
        TRY_GOTO(check_ascii_stl(path, bytes, &size, err));
        TRY_GOTO(read_lines(&reader, bytes, read_stl_line, err));
    }
    if (soup->n == 0)
        status = err_set(err, STATUS_INPUT, "%s: has no triangles", path);
done:
    free(reader.vertices);
    free(bytes);
    return status;
}
