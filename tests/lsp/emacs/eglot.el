;;; eglot.el --- The snippet of docs/how-to/editor.md in Emacs, with the language server  -*- lexical-binding: t -*-

;; emacs --batch -l eglot.el, with HYSTERON_TOOL as the program. Emacs before 29 has no Eglot: exit code 77.

(when (< emacs-major-version 29)
  (message "Emacs %s has no Eglot" emacs-version)
  (kill-emacs 77))

(defconst tests-source-dir (expand-file-name "../../.." (file-name-directory load-file-name)))

(let ((folder (make-temp-file "hysteron" t)))
  (make-symbolic-link (getenv "HYSTERON_TOOL") (expand-file-name "hysteron" folder))
  (push folder exec-path)
  (setq-default default-directory (file-name-as-directory folder)))

(defun tests-require (holds what)
  "Ends with an error that names WHAT where HOLDS is nil."
  (unless holds (error "Not so: %s" what))
  (message "ok: %s" what))

;; The snippet, as a user copies it.
(with-temp-buffer
  (insert-file-contents (expand-file-name "docs/how-to/editor.md" tests-source-dir))
  (search-forward "\n## Emacs\n")
  (search-forward "\n```text\n")
  (let ((begin (point)))
    (search-forward "\n```\n")
    (eval-region begin (match-beginning 0))))

(require 'eglot)
(setq eglot-sync-connect t)
(let ((file (expand-file-name "plant.st" default-directory)))
  (with-temp-file file
    (insert "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
            "  VAR AMP : HY_GAIN := (K := 2.0); END_VAR\n  AMP(XNI := U);\n  Y := AMP.XOUT;\nEND_FUNCTION_BLOCK\n"))
  (find-file file))
(tests-require (eq major-mode 'st-mode) "the file opens in st-mode")
(apply #'eglot (eglot--guess-contact)) ; `eglot-ensure' waits for a display
(with-timeout (60 (error "No diagnostics within 60 s"))
  (while (null (flymake-diagnostics)) (accept-process-output nil 0.1)))
(tests-require (seq-some (lambda (one) (and (string-match-p "HY202" (flymake-diagnostic-text one))
                                            (= 5 (line-number-at-pos (flymake-diagnostic-beg one)))))
                         (flymake-diagnostics))
               "the wrong pin is underlined in its line")
(goto-char (point-min))
(search-forward "AMP : HY_G")
(tests-require (string-match-p "Multiplies a signal by a constant"
                               (format "%S" (jsonrpc-request (eglot-current-server) :textDocument/hover
                                                             (eglot--TextDocumentPositionParams))))
               "a block's card is shown")
(search-forward "AMP.")
(tests-require (equal '("XOUT") (all-completions "" (nth 2 (eglot-completion-at-point)))) "outputs are completed")
(search-backward "AMP(")
(tests-require (equal '(4) (mapcar (lambda (one) (xref-location-line (xref-item-location one)))
                                   (xref-backend-definitions 'eglot (xref-backend-identifier-at-point 'eglot))))
               "a definition is found")
(eglot-rename "GAIN_1")
(tests-require (= 3 (how-many "GAIN_1" (point-min) (point-max))) "a variable is renamed")
(eglot-format-buffer)
(goto-char (point-min))
(tests-require (search-forward "  VAR_INPUT\n    U : LREAL;\n  END_VAR\n" nil t) "the text is laid out")
(set-buffer-modified-p nil)
(eglot-shutdown (eglot-current-server))
