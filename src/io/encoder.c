/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/encoder.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/memory.h"

#define PATH_BYTES 4096
#define WORDS_BYTES 200
#define NOT_FOUND 127 /* exit status where posix_spawnp cannot tell before: POSIX */

extern char **environ;

struct ptie_encoder {
    const char *path;
    pid_t process;
    int input;      /* our end of its standard input: a socket, because a pipe could kill us by SIGPIPE */
    FILE *complaints; /* its standard error: a file, which is never full */
};

static void encoder_free(ptie_encoder *encoder) {
    if (encoder->input >= 0) close(encoder->input);
    if (encoder->complaints) fclose(encoder->complaints);
    ptie_free(encoder);
}

/* posix_spawnp, with the program's input, output and errors in place.  Returns an errno. */
static int spawn(ptie_encoder *encoder, int input, char *const *arguments) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&files);
    if (error) return error;
    error = posix_spawnattr_init(&attributes);
    if (error) {
        posix_spawn_file_actions_destroy(&files);
        return error;
    }
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP); /* Ctrl-C is for us to act on */
    error = posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    if (!error)
        error = posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!error)
        error = posix_spawn_file_actions_adddup2(&files, fileno(encoder->complaints), STDERR_FILENO);
    if (!error)
        error = posix_spawnp(&encoder->process, arguments[0], &files, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

static ptie_status cannot_start(const ptie_encoder *encoder, int error) {
    return PTIE_FAIL(error == ENOENT ? PTIE_EUNSUPPORTED : PTIE_EIO,
                     "%s: cannot start ffmpeg: %s (expected it in PATH; .y4m does without)",
                     encoder->path, strerror(error));
}

/* H.264 as every player and slide program shows it: 4:2:0 needs even sides, and the colours are those of Y4M. */
static ptie_status start_ffmpeg(ptie_encoder *encoder, const char *part) {
    char output[PATH_BYTES];
    int ends[2];
    snprintf(output, sizeof output, "file:%s", part); /* whatever its name begins with */
    const char *const arguments[] = {
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-y", "-f", "yuv4mpegpipe", "-i", "pipe:0", "-vf",
        "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p",
        "-colorspace", "smpte170m", "-movflags", "+faststart", "-f", "mp4", output, NULL};
    char *writable[sizeof arguments / sizeof *arguments];
    memcpy(writable, arguments, sizeof arguments);
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return PTIE_FAIL(PTIE_EIO, "%s: cannot reach ffmpeg: %s", encoder->path, strerror(errno));
    encoder->input = ends[0];
    const int error = spawn(encoder, ends[1], writable);
    close(ends[1]);
    if (error == 0) return PTIE_OK;
    encoder->process = 0;
    return cannot_start(encoder, error);
}

ptie_status ptie_encoder_start(ptie_encoder **out, const char *path, const char *part) {
    ptie_encoder *encoder;
    *out = NULL;
    PTIE_TRY(ptie_alloc_status(&encoder, 1, sizeof *encoder, path));
    encoder->path = path;
    encoder->input = -1;
    encoder->complaints = tmpfile();
    ptie_status status =
        encoder->complaints
            ? start_ffmpeg(encoder, part)
            : PTIE_FAIL(PTIE_EIO, "%s: cannot make a temporary file: %s", path, strerror(errno));
    if (status != PTIE_OK) {
        encoder_free(encoder);
        return status;
    }
    *out = encoder;
    return PTIE_OK;
}

/* The first line ffmpeg has complained in. */
static const char *complaint(const ptie_encoder *encoder, char words[WORDS_BYTES]) {
    rewind(encoder->complaints);
    if (!fgets(words, WORDS_BYTES, encoder->complaints)) return "no reason given";
    words[strcspn(words, "\n")] = 0;
    return words;
}

/* Has it ended well? */
static ptie_status wait_for(ptie_encoder *encoder) {
    char words[WORDS_BYTES];
    int result;
    pid_t ended;
    do ended = waitpid(encoder->process, &result, 0);
    while (ended < 0 && errno == EINTR);
    encoder->process = 0;
    if (ended > 0 && WIFEXITED(result) && WEXITSTATUS(result) == 0) return PTIE_OK;
    if (ended > 0 && WIFEXITED(result) && WEXITSTATUS(result) == NOT_FOUND)
        return cannot_start(encoder, ENOENT);
    return PTIE_FAIL(PTIE_EIO, "%s: ffmpeg failed: %s", encoder->path, complaint(encoder, words));
}

ptie_status ptie_encoder_write(ptie_encoder *encoder, const void *bytes, size_t count) {
    const unsigned char *next = bytes;
    while (count > 0 && encoder->process) {
        const ssize_t now = send(encoder->input, next, count, MSG_NOSIGNAL);
        if (now < 0 && errno == EINTR) continue;
        if (now < 0) {
            PTIE_TRY(wait_for(encoder));
            break;
        }
        next += now;
        count -= (size_t)now;
    }
    return count == 0 ? PTIE_OK
                      : PTIE_FAIL(PTIE_EIO, "%s: ffmpeg ended before the last frame", encoder->path);
}

ptie_status ptie_encoder_finish(ptie_encoder *encoder) {
    close(encoder->input); /* the end of the recording */
    encoder->input = -1;
    ptie_status status = wait_for(encoder);
    encoder_free(encoder);
    return status;
}

void ptie_encoder_stop(ptie_encoder *encoder) {
    int result;
    if (!encoder) return;
    if (encoder->process) {
        kill(encoder->process, SIGKILL);
        while (waitpid(encoder->process, &result, 0) < 0 && errno == EINTR) continue;
    }
    encoder_free(encoder);
}
