// Names that the C library declares outside of any namespace, in the headers that C++'s own bring along: functions,
// types and variables of glibc, as `gcc -aux-info` lists them. A namespace of one of these names does not compile.
#pragma once

#include <string_view>

namespace hysteron {

/// Separated by blanks and line ends. Variants that nobody names a block after (acosf32x, strtol_l) are left out.
inline constexpr std::string_view c_library_names = R"(
    a64l abort abs accept accept4 access acct acos acosf acosh acoshf adjtime alarm aligned_alloc alloca arc4random
    arc4random_buf arc4random_uniform asctime asin asinf asinh asinhf asprintf atan atan2 atan2f atanf atanh atanhf
    atexit atof atoi atol atoll basename bcmp bcopy bind brk bsearch btowc bzero c16rtomb c32rtomb c8rtomb caddr_t
    calloc canonicalize canonicalizef cbrt cbrtf ceil ceilf chdir chmod chown chroot clearenv clearerr
    clearerr_unlocked clock clock_adjtime clock_getcpuclockid clock_getres clock_gettime clock_nanosleep
    clock_settime clock_t clone close close_range closefrom cmsghdr confstr connect copysign copysignf cos cosf cosh
    coshf creat creat64 crypt ctermid ctime cuserid daddl daemon daylight ddivl dev_t dfmal difftime div div_t dmull
    double_t dprintf drand48 drand48_data drem dremf dreml dsqrtl dsubl dup dup2 dup3 duplocale dysize eaccess ecvt
    endusershell environ erand48 erf erfc erfcf erff euidaccess execl execle execlp execv execve execveat execvp
    execvpe exit exp exp10 exp10f exp2 exp2f expf explicit_bzero expm1 expm1f fabs fabsf faccessat fadd faddl
    fallocate fallocate64 fchdir fchmod fchmodat fchown fchownat fclose fcloseall fcntl fcntl64 fcvt fdatasync fdim
    fdimf fdiv fdivl fdopen feclearexcept fedisableexcept feenableexcept fegetenv fegetexcept fegetexceptflag
    fegetmode fegetround feholdexcept feof feof_unlocked feraiseexcept ferror ferror_unlocked fesetenv fesetexcept
    fesetexceptflag fesetmode fesetround fetestexcept fetestexceptflag feupdateenv fexecve fflush fflush_unlocked
    ffma ffmal ffs ffsl ffsll fgetc fgetc_unlocked fgetpos fgetpos64 fgets fgets_unlocked fgetwc fgetwc_unlocked
    fgetws fgetws_unlocked fileno fileno_unlocked finite finitef finitel float_t flock flockfile floor floorf fma
    fmaf fmax fmaxf fmaximum fmaximum_mag fmaximum_magf fmaximum_num fmaximum_numf fmaximumf fmaxmag fmaxmagf
    fmemopen fmin fminf fminimum fminimum_mag fminimum_magf fminimum_num fminimum_numf fminimumf fminmag fminmagf
    fmod fmodf fmul fmull fopen fopen64 fopencookie fork fpathconf fpos_t fprintf fputc fputc_unlocked fputs
    fputs_unlocked fputwc fputwc_unlocked fputws fputws_unlocked fread fread_unlocked free freelocale freopen
    freopen64 frexp frexpf fromfp fromfpf fromfpx fromfpxf fscanf fseek fseeko fseeko64 fsetpos fsetpos64 fsid_t
    fsqrt fsqrtl fstat fstat64 fstatat fstatat64 fsub fsubl fsync ftell ftello ftello64 ftruncate ftruncate64
    ftrylockfile funlockfile futimens futimes futimesat fwide fwprintf fwrite fwrite_unlocked fwscanf gamma gammaf
    gammal gcvt getc getc_unlocked getchar getchar_unlocked getcpu getcwd getdate getdelim getdomainname
    getdtablesize getegid getentropy getenv geteuid getgid getgroups gethostid gethostname getitimer getline
    getloadavg getlogin getopt getpagesize getpass getpayload getpayloadf getpeername getpgid getpgrp getpid getppid
    getpt getresgid getresuid getsid getsockname getsockopt getsubopt gettid gettimeofday getuid getumask
    getusershell getw getwc getwc_unlocked getwchar getwchar_unlocked getwd gid_t gmtime grantpt group_member gsignal
    hypot hypotf ilogb ilogbf imaxabs imaxdiv index initstate iovec isalnum isalpha isascii isatty isblank iscntrl
    isctype isdigit isfdtype isgraph isinf isinff isinfl islower isnan isnanf isnanl isprint ispunct isspace isupper
    isxdigit itimerspec itimerval j0 j0f j1 j1f jmp_buf jn jnf jrand48 key_t kill killpg l64a labs lchmod lchown
    lcong48 lconv ldexp ldexpf ldiv ldiv_t lgamma lgammaf linger link linkat linux listen llabs lldiv llogb llogbf
    llrint llrintf llround llroundf locale_t localeconv localtime lockf log log10 log10f log1p log1pf log2 log2f logb
    logbf logf longjmp lrand48 lrint lrintf lround lroundf lseek lseek64 lstat lstat64 lutimes madvise malloc
    max_align_t mblen mbrlen mbrtoc16 mbrtoc32 mbrtoc8 mbrtowc mbsinit mbsnrtowcs mbsrtowcs mbstowcs mbtowc memccpy
    memchr memcmp memcpy memfd_create memfrob memmem memmove mempcpy memrchr memset mincore mkdir mkdirat mkdtemp
    mkfifo mkfifoat mknod mknodat mkostemp mkostemp64 mkostemps mkostemps64 mkstemp mkstemp64 mkstemps mkstemps64
    mktemp mktime mlock mlock2 mlockall mmap mmap64 mode_t modf modff mprotect mrand48 mremap msghdr msync munlock
    munlockall munmap nan nanf nanosleep nearbyint nearbyintf newlocale nextafter nextafterf nextdown nextdownf
    nexttoward nexttowardf nexttowardl nextup nextupf nice nrand48 nullptr_t obstack_printf obstack_vprintf off_t
    on_exit open open64 open_memstream open_wmemstream openat openat64 optarg opterr optind option optopt pathconf
    pause pclose perror pid_t pipe pipe2 pkey_alloc pkey_free pkey_get pkey_mprotect pkey_set poll pollfd popen
    posix_fadvise posix_fadvise64 posix_fallocate posix_fallocate64 posix_madvise posix_memalign posix_openpt pow
    powf ppoll pread pread64 printf process_madvise process_mrelease profil pselect psiginfo psignal ptsname putc
    putc_unlocked putchar putchar_unlocked putenv puts putw putwc putwc_unlocked putwchar putwchar_unlocked pwrite
    pwrite64 qecvt qfcvt qgcvt qsort quick_exit raise rand random random_data rawmemchr read readahead readlink
    readlinkat realloc reallocarray realpath recv recvfrom recvmmsg recvmsg remainder remainderf remove remquo
    remquof rename renameat renameat2 revoke rewind rindex rint rintf rmdir round roundeven roundevenf roundf rpmatch
    sbrk scalb scalbf scalbl scalbln scalblnf scalbn scalbnf scanf sched_param secure_getenv seed48 select send
    sendmmsg sendmsg sendto setbuf setbuffer setdomainname setegid setenv seteuid setgid sethostid sethostname
    setitimer setjmp setlinebuf setlocale setlogin setns setpayload setpayloadf setpayloadsig setpayloadsigf setpgid
    setpgrp setregid setresgid setresuid setreuid setsid setsockopt setstate settimeofday setuid setusershell setvbuf
    shm_open shm_unlink shutdown sigabbrev_np sigaction sigaddset sigaltstack sigandset sigblock sigdelset
    sigdescr_np sigemptyset sigevent sigfillset siggetmask sighold sigignore siginterrupt sigisemptyset sigismember
    siglongjmp signal signgam significand significandf significandl sigorset sigpause sigpending sigprocmask sigqueue
    sigrelse sigreturn sigset sigsetmask sigstack sigsuspend sigtimedwait sigwait sigwaitinfo sin sincos sincosf sinf
    sinh sinhf size_t sleep snprintf sockaddr sockatmark socket socketpair splice sprintf sqrt sqrtf srand srand48
    srandom sscanf ssignal ssize_t stat stat64 statx stderr stdin stdout stpcpy stpncpy strcasecmp strcasestr strcat
    strchr strchrnul strcmp strcoll strcpy strcspn strdup strerror strerrordesc_np strerrorname_np strfromd strfromf
    strfroml strfry strftime strlen strncasecmp strncat strncmp strncpy strndup strnlen strpbrk strptime strrchr
    strsep strsignal strspn strstr strtod strtof strtoimax strtok strtol strtold strtoll strtoq strtoul strtoull
    strtoumax strtouq strverscmp strxfrm swab swprintf swscanf symlink symlinkat sync syncfs syscall sysconf system
    sysv_signal tan tanf tanh tanhf tcgetpgrp tcsetpgrp tee tempnam tgamma tgammaf tgkill time time_t timegm
    timelocal timer_create timer_delete timer_getoverrun timer_gettime timer_settime timer_t timespec timespec_get
    timespec_getres timeval timezone tm tmpfile tmpfile64 tmpnam toascii tolower totalorder totalorderf totalordermag
    totalordermagf toupper trunc truncate truncate64 truncf ttyname ttyslot tzset ualarm ucred ufromfp ufromfpf
    ufromfpx ufromfpxf uid_t uint ulong umask ungetc ungetwc unix unlink unlinkat unlockpt unsetenv unshare uselocale
    ushort usleep utimensat utimes valloc vasprintf vdprintf vfork vfprintf vfscanf vfwprintf vfwscanf vhangup
    vmsplice vprintf vscanf vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcpcpy wcpncpy wcrtomb
    wctob wctomb wctrans wctype wcwidth wint_t wprintf write wscanf y0 y0f y1 y1f yn ynf
)";

}  // namespace hysteron
