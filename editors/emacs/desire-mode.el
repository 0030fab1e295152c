;;; desire-mode.el --- Programs in the language of Desire -*- lexical-binding: t -*-

;; Package-Requires: ((emacs "27.1"))

;;; Commentary:
;; A mode for .src files, and `desire lsp' for eglot, which Emacs has since version 29 (`elpa-eglot' before):
;;   (load "/path/to/desire-mode.el")
;;   (add-hook 'desire-mode-hook #'eglot-ensure)

;;; Code:

;; eglot has no public names for a buffer's server and address
(declare-function eglot--current-server-or-lose "eglot")
(declare-function eglot--signal-textDocument/didChange "eglot")
(declare-function eglot--TextDocumentIdentifier "eglot")
(declare-function jsonrpc-async-request "jsonrpc")

(defvar desire-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?- ". 12" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?' "\"" table)
    (modify-syntax-entry ?\" "\"" table)
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?$ "_" table)
    (modify-syntax-entry ?| "." table)
    table)
  "Comments begin with --, strings stand in either quotes.")

(defvar desire-font-lock-keywords
  '(("\\(?:^\\|[|]\\|\\<then\\|\\<else\\)[ \t]*\\(\\(?:Vec\\w+[ \t]+\\)?d/dt\\|[A-Za-z]+\\(?:[ \t]+\\(?:to\\|if\\|while\\|event\\)\\)?\\)\\(?:[ \t]+[^= \t]\\|[ \t]*$\\)"
     1 font-lock-keyword-face)
    ("\\_<\\(?:then\\|to\\|and\\|or\\|not\\)\\_>" . font-lock-keyword-face)
    ("\\_<\\([A-Za-z][A-Za-z0-9_$]*\\)(" 1 font-lock-function-name-face))
  "Colours of keywords and functions.")

;;;###autoload
(define-derived-mode desire-mode prog-mode "Desire"
  "Major mode for programs in the language of Desire."
  (setq-local comment-start "-- " comment-start-skip "--+[ \t]*" indent-tabs-mode nil tab-width 2)
  (setq-local font-lock-defaults '(desire-font-lock-keywords)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.src\\'" . desire-mode))

(defun desire-run ()
  "Run the program in this buffer as it stands; its graph opens in another window."
  (interactive)
  (eglot--signal-textDocument/didChange)
  (jsonrpc-async-request
   (eglot--current-server-or-lose) :workspace/executeCommand
   (list :command "desire.run" :arguments (vector (plist-get (eglot--TextDocumentIdentifier) :uri)))
   :timeout nil
   :success-fn (lambda (answer) (seq-do #'find-file-other-window (plist-get answer :pictures)))
   :error-fn (lambda (reason) (message "desire: %s" (plist-get reason :message)))))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(desire-mode . ("desire" "lsp")))
  (define-key desire-mode-map (kbd "C-c C-c") #'desire-run))

(provide 'desire-mode)
;;; desire-mode.el ends here
