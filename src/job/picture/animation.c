/* Makes the scenes of the pictures of an animation. A picture differs from the next in one thing:
 * colors (a series), the view (a turn) or the geometry (growth). A series and a turn keep the
 * geometry, so a renderer prepares it once, and each picture costs its pixels only. */
#include "job/picture/animation.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Maximum number of a picture in --moments. It only keeps a number within an int; animation_count
 * checks it against the number of frames. */
enum { MOST_PICTURES = 1000000 };

/* Reads "all", "A..B" or "A". After "all", animation->last is 0 until animation_count sets it. */
static bool read_frames(const char *text, Animation *animation)
{
    const char *dots = strstr(text, "..");
    char first[16];
    long long from, to;
    if (strcmp(text, "all") == 0) {
        animation->first = 1;
        return true;
    }
    size_t length = dots ? (size_t)(dots - text) : strlen(text);
    if (length >= sizeof first)
        return false;
    memcpy(first, text, length);
    first[length] = '\0';
    if (!integer_parse(first, 1, MOST_PICTURES, &from) ||
        !integer_parse(dots ? dots + 2 : first, from, MOST_PICTURES, &to))
        return false;
    animation->first = (int)from;
    animation->last = (int)to;
    return true;
}

/* The number in a pattern of file names: its one %d, %4d or %04d. */
typedef struct NumberPattern {
    size_t start, length; /* of the characters from the percent sign to the d */
    int width;            /* minimum number of characters of the number; 0: no minimum */
    bool zeros;           /* the number is padded with zeros, not with blanks */
} NumberPattern;

/* Finds the number in a pattern; false if there is none, or more than one percent sign. The width
 * has at most one digit. */
static bool find_number(const char *pattern, NumberPattern *number)
{
    const char *percent = strchr(pattern, '%');
    if (!percent)
        return false;
    const char *at = percent + 1;
    NumberPattern found = {.start = (size_t)(percent - pattern), .zeros = *at == '0'};
    if (*at >= '0' && *at <= '9')
        found.width = *at++ - '0';
    if (found.width == 0 && found.zeros && *at >= '1' && *at <= '9')
        found.width = *at++ - '0';
    found.length = (size_t)(at + 1 - percent);
    *number = found;
    return *at == 'd' && !strchr(at, '%');
}

static Status check_pattern(const char *output, Err *err)
{
    NumberPattern number;
    if (find_number(output, &number))
        return STATUS_OK;
    return err_set(err, STATUS_USAGE, "-o: '%s' must contain the picture number, as in f%%04d.png",
                   output);
}

Status animation_read(const AnimationOptions *options, const char *output, Animation *animation,
                      Err *err)
{
    Animation made = {.first = 1};
    if ((options->frames != NULL) + (options->turn > 0) + (options->growth > 0) > 1)
        return err_set(err, STATUS_USAGE,
                       "--moments, --turntable and --growth exclude each other; give one");
    if (options->frames) {
        made.kind = ANIMATION_SERIES;
        if (!read_frames(options->frames, &made))
            return err_set(err, STATUS_USAGE,
                           "--moments: '%.40s' is not valid; use all or A..B, such as 1..24",
                           options->frames);
    } else if (options->turn || options->growth) {
        made.kind = options->turn ? ANIMATION_TURN : ANIMATION_GROWTH;
        made.n = made.last = options->turn ? options->turn : options->growth;
    } else {
        made.n = made.last = 1;
    }
    if (made.kind != ANIMATION_NONE)
        TRY(check_pattern(output, err));
    *animation = made;
    return STATUS_OK;
}

Status animation_count(Animation *animation, const Appearance *appearance, Err *err)
{
    if (animation->kind != ANIMATION_SERIES)
        return STATUS_OK;
    int n = (int)appearance->n_frames;
    if (n == 0)
        return err_set(
            err, STATUS_USAGE,
            "--moments: %s does not change with time; give --color-by with values that do",
            appearance->name ? appearance->name : "the picture");
    if (animation->last > n)
        return err_set(err, STATUS_USAGE, "--moments: %s has %d time steps, not %d",
                       appearance->name, n, animation->last);
    animation->n = n;
    if (animation->last == 0)
        animation->last = n;
    return STATUS_OK;
}

Status animation_path(const Animation *animation, const char *pattern, int number, char **path,
                      Err *err)
{
    NumberPattern at;
    if (animation->kind == ANIMATION_NONE || !find_number(pattern, &at))
        return mem_strdup(path, pattern, err);
    Text name = TEXT_INIT;
    text_append(&name, pattern, at.start);
    text_printf(&name, at.zeros ? "%0*d" : "%*d", at.width, number);
    text_puts(&name, pattern + at.start + at.length);
    Status status = text_take(&name, path, err);
    text_release(&name);
    return status;
}

Status animation_fit_camera(const PictureOptions *options, const PictureSource *source,
                            Scene *scene, Err *err)
{
    ViewParams params = picture_view_params(options, source);
    if (params.has_location || options->has_height)
        return STATUS_OK;
    orbit_frame_turn(&params, &scene->geometry);
    return stage_view(&source->look, &params, &scene->geometry, &scene->view, err);
}

/* Copies the entries of nodes whose colors a part of a tree has. */
static void copy_part(const Appearance *shown, const Tree *tree, const Tree *part, Appearance *made)
{
    for (size_t i = 0, k = 0; i < part->n; i++, k++) {
        while (tree->id[k] != part->id[i])
            k++;
        made->colors[i] = shown->colors[k];
        if (made->positions)
            made->positions[i] = shown->positions[k];
    }
}

/* Copies the colors of a part of a tree, whose nodes are in the same order. The pieces of a segment
 * have the same id; the part has the first of them. Values and names are left out, because only a
 * legend needs them. */
static Status part_appearance(const Appearance *whole, const Tree *tree, const Tree *part,
                              Appearance *out, Err *err)
{
    const Appearance shown = appearance_frame(whole, 0);
    Appearance made = {
        .finish = shown.finish, .color = shown.color, .scale = shown.scale, .n_values = part->n};
    Status status;
    made.scale.map = (Colormap){0}; /* owned by `whole`; the ramp holds the colors */
    if (shown.colors)
        TRY_GOTO(mem_calloc(&made.colors, part->n, sizeof *made.colors, "colors", err));
    if (shown.positions) {
        TRY_GOTO(mem_calloc(&made.positions, part->n, sizeof *made.positions, "colors", err));
        TRY_GOTO(mem_calloc(&made.ramp, 1, sizeof *made.ramp, "colors", err));
        *made.ramp = *shown.ramp;
    }
    if (shown.colors)
        copy_part(&shown, tree, part, &made);
    *out = made;
    return STATUS_OK;
done:
    appearance_release(&made);
    return status;
}

/* Makes the scene of the tree as far as it has grown, in the view of the whole tree. `part`, 0 to
 * 1, is the fraction of the tree [tree_proximal_part]. The origin of a geometry depends on its
 * bounds, so the view moves by the difference of the two origins. */
static Status grow_to(const AnimationInput *subject, double part, Scene *grown, Err *err)
{
    const Scene *whole = subject->whole;
    const Tree *tree = &subject->source->of.tree;
    const SmoothTree *smooth = picture_pieces(&subject->source->of);
    PictureSource part_source = *subject->source;
    Status status;
    if (smooth)
        TRY(smoothtree_part(smooth, part, &part_source.of.smooth, err));
    else
        TRY(tree_proximal_part(tree, part, &part_source.of.tree, err));
    status = picture_geometry(subject->options, &part_source, subject->common, &grown->geometry,
                              NULL, err);
    if (status == STATUS_OK)
        status = part_appearance(&whole->appearance, smooth ? &smooth->tree : tree,
                                 smooth ? &part_source.of.smooth.tree : &part_source.of.tree,
                                 &grown->appearance, err);
    if (smooth)
        smoothtree_release(&part_source.of.smooth);
    else
        tree_release(&part_source.of.tree);
    Vec3 moved = vec3_sub(whole->geometry.origin, grown->geometry.origin);
    grown->view = view_moved(&whole->view, moved);
    return status;
}

/* Makes the geometry of a frame of a series, with the radii of that frame. */
static Status beat_at(const AnimationInput *subject, int number, Scene *shown, Scene *grown,
                      Err *err)
{
    PictureOptions options = *subject->options;
    options.coloring.frame = number;
    TRY(picture_geometry(&options, subject->source, subject->common, &grown->geometry, NULL, err));
    shown->geometry = grown->geometry;
    shown->view =
        view_moved(&shown->view, vec3_sub(subject->whole->geometry.origin, grown->geometry.origin));
    return STATUS_OK;
}

Status animation_scene(const Animation *animation, const AnimationInput *subject, int number,
                       Scene *shown, Scene *grown, Err *err)
{
    const Scene *whole = subject->whole;
    /* The camera turns against the sense in which the tree seems to turn. */
    double angle = -FULL_TURN * (number - 1) / animation->n;
    *shown = *whole;
    if (animation->kind == ANIMATION_SERIES)
        shown->appearance = appearance_frame(&whole->appearance, (size_t)(number - 1));
    if (animation->kind == ANIMATION_TURN)
        shown->view = view_turned(&whole->view, box_center(whole->geometry.bounds),
                                  whole->view.camera.up, angle);
    if (!animation_changes_geometry(animation, subject->options))
        return STATUS_OK;
    if (animation->kind == ANIMATION_SERIES)
        return beat_at(subject, number, shown, grown, err);
    TRY(grow_to(subject, (double)number / animation->n, grown, err));
    *shown = *grown;
    return STATUS_OK;
}
