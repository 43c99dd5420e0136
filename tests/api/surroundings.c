/* A program with its own locale, signal handlers, umask and standard streams grows, draws and
 * writes a tree. Afterwards all of them must be unchanged, and numbers in files must have a
 * '.'. */
#include "corcast.h"
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern char **environ;

static void handle(int number)
{
    (void)number;
}

/* What the library must leave alone. */
typedef struct Surroundings {
    struct sigaction actions[32];
    mode_t mask;
    char locale[256], folder[512];
    char **environment;
    size_t n_variables;
} Surroundings;

static void look(Surroundings *now)
{
    memset(now, 0, sizeof *now);
    for (int i = 1; i < 32; i++)
        sigaction(i, NULL, &now->actions[i]);
    now->mask = umask(0);
    umask(now->mask);
    snprintf(now->locale, sizeof now->locale, "%s", setlocale(LC_ALL, NULL));
    if (!getcwd(now->folder, sizeof now->folder))
        exit(1);
    now->environment = environ;
    while (environ[now->n_variables])
        now->n_variables++;
}

static int failures;

static void expect(int holds, const char *what)
{
    if (!holds)
        failures++, fprintf(stderr, "%s\n", what);
}

static int in_callers_locale(void *user, const char *step, double fraction)
{
    char text[16];
    (void)step;
    (void)fraction;
    snprintf(text, sizeof text, "%.1f", 1.5);
    *(int *)user = *(int *)user && text[1] == localeconv()->decimal_point[0];
    return 0;
}

static void work(corcast_error *error)
{
    int in_locale = 1;
    corcast_options *options = NULL;
    corcast_tree *tree = NULL;
    corcast_scene *scene = NULL;
    corcast_image *image = NULL;
    int status = corcast_options_new("grow", &options, error);
    status = status ? status : corcast_options_set(options, "terminals", "300", error);
    status = status ? status : corcast_options_set(options, "gamma", "2.75", error);
    status = status
                 ? status
                 : corcast_options_callbacks(options, in_callers_locale, NULL, &in_locale, error);
    status = status ? status : corcast_grow(options, &tree, NULL, error);
    status = status ? status : corcast_tree_write(tree, "library.swc", error);
    status = status ? status : corcast_scene_new(tree, NULL, &scene, error);
    status = status ? status : corcast_render(scene, &image, NULL, error);
    status = status ? status
                    : corcast_image_write(image, CORCAST_COLOR, CORCAST_U8, "library.png", error);
    expect(status == 0, corcast_error_text(error));
    expect(in_locale, "a callback did not have the locale of its caller");
    corcast_image_free(image);
    corcast_scene_free(scene);
    corcast_tree_free(tree);
    corcast_options_free(options);
}

int main(void)
{
    Surroundings before, after;
    signal(SIGINT, handle);
    signal(SIGTERM, handle);
    signal(SIGPIPE, SIG_IGN);
    umask(027);
    setlocale(LC_ALL, "");
    corcast_error *error = corcast_error_new();
    look(&before);
    work(error);
    look(&after);
    for (int i = 1; i < 32; i++)
        expect(before.actions[i].sa_handler == after.actions[i].sa_handler &&
                   before.actions[i].sa_flags == after.actions[i].sa_flags,
               "a signal handler has changed");
    expect(before.mask == after.mask, "the umask has changed");
    expect(strcmp(before.locale, after.locale) == 0, "the locale has changed");
    expect(strcmp(before.folder, after.folder) == 0, "the working folder has changed");
    expect(before.environment == after.environment && before.n_variables == after.n_variables,
           "the environment has changed");
    corcast_error_free(error);
    return failures > 0;
}
