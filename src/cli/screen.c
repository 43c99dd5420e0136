/* Prints messages and progress of a command to standard error. Progress is one line, which a
 * terminal overwrites. The remaining time is estimated from the mean speed of the step so far. */
#include "cli/screen.h"

#include "base/base.h"
#include "cli/interrupt.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Formats the remaining time: ", 12 s left". Returns "" as long as the estimate is too uncertain:
 * in the first second, and then until 1 % of the work is done or 10 s have passed. */
static const char *time_left(double elapsed_s, double fraction, char out[32])
{
    double left_s = elapsed_s * (1 - fraction) / fraction;
    out[0] = '\0';
    if (elapsed_s < 1 || !(fraction >= (elapsed_s < 10 ? 0.01 : 1e-6)))
        return out;
    if (left_s < 100)
        snprintf(out, 32, ", %.0f s left", left_s);
    else if (left_s < 6000) /* each unit is used for up to two digits */
        snprintf(out, 32, ", %.0f min left", left_s / 60);
    else
        snprintf(out, 32, ", %.0f h left", left_s / 3600);
    return out;
}

static void begin_step(Screen *screen, const char *what)
{
    screen->what = what;
    screen->start_s = clock_seconds();
    screen->last_s = screen->terminal ? 0 : screen->start_s;
}

static void clear_line(Screen *screen)
{
    if (screen->shown)
        fputs("\r\033[K", stderr);
    screen->shown = false;
}

static void end_step(Screen *screen)
{
    clear_line(screen);
    if (screen->catches)
        interrupt_release();
    screen->catches = false;
    screen->what = NULL;
}

/* Shows the progress of the step `what`; NULL ends the step. A terminal is updated 10 times a
 * second, more often than a reader can follow; a log gets a line in 10 s. */
static void show(Screen *screen, const char *what, double fraction)
{
    char left[32];
    if (!what) {
        end_step(screen);
        return;
    }
    if (what != screen->what)
        begin_step(screen, what);
    double now_s = clock_seconds();
    if (screen->quiet || now_s - screen->last_s < (screen->terminal ? 0.1 : 10))
        return;
    screen_print_held(screen);
    screen->last_s = now_s;
    screen->shown = screen->terminal;
    fprintf(stderr, screen->terminal ? "\r%s %3.0f %%%s\033[K" : "%s: %.0f %%%s\n", what,
            100 * fraction, time_left(now_s - screen->start_s, fraction, left));
    fflush(stderr);
}

/* From the first call on, the first SIGINT only sets the flag, until the step ends. */
static bool is_enough(void *user)
{
    Screen *screen = user;
    if (!screen->catches)
        interrupt_catch();
    screen->catches = true;
    return interrupt_asked();
}

/* Never stops the operation; only a signal does. */
static bool show_progress(void *user, const char *what, double fraction)
{
    show(user, what, fraction);
    return true;
}

/* Takes the first sentence that is held back; the caller frees it. */
static HeldMessage *take_held(Screen *screen)
{
    HeldMessage *first = screen->held;
    if (first)
        screen->held = first->next;
    return first;
}

void screen_print_held(Screen *screen)
{
    screen->prompt = true;
    if (screen->held)
        clear_line(screen);
    for (HeldMessage *held; (held = take_held(screen)); free(held))
        fprintf(stderr, "corcast: %s\n", held->text);
}

void screen_drop_held(Screen *screen)
{
    for (HeldMessage *held; (held = take_held(screen)); free(held))
        ;
}

/* Copies a sentence to the end of the list of held sentences. Returns false if memory runs out. */
static bool hold(Screen *screen, const char *sentence)
{
    HeldMessage **end = &screen->held;
    while (*end)
        end = &(*end)->next;
    *end = malloc(sizeof **end + strlen(sentence) + 1);
    if (!*end)
        return false;
    (*end)->next = NULL;
    strcpy((*end)->text, sentence);
    return true;
}

/* Prints a note or warning, or holds it back until progress is first shown. */
static void take_sentence(void *user, TalkKind kind, const char *sentence)
{
    Screen *screen = user;
    if ((kind == TALK_NOTE && screen->quiet) || (!screen->prompt && hold(screen, sentence)))
        return;
    screen_print_held(screen);
    clear_line(screen);
    fprintf(stderr, "corcast: %s\n", sentence);
}

Talk screen_talk(Screen *screen, bool quiet)
{
    *screen = (Screen){.quiet = quiet, .terminal = isatty(STDERR_FILENO)};
    return (Talk){
        .say = take_sentence, .progress = show_progress, .enough = is_enough, .user = screen};
}
